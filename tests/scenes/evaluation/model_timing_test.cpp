#include "scenes/evaluation/evaluate.h"

#include <gtest/gtest.h>

#include "engine/tick/sensor_identification.h"
#include "tests/support/example_model.h"

namespace palpate {
namespace {

TEST(ModelTiming, MeasuresTheTickAndTheEvaluationInIt) {
  const Recording recording = test::example_recording(1000, 1000.0);
  std::vector<ToolSample> samples;
  for (const RecordingRow& row : recording.rows) {
    if (row.position_m > 0.0) samples.push_back(tool_sample(row));
  }
  const auto model = std::make_shared<const FittedModel>(test::example_models().front());
  const ModelTiming timing = time_models({model}, {{{}, samples}}).front();
  EXPECT_TRUE(timing.measured);
  EXPECT_GT(timing.evaluation.median_ns, 0.0);
  EXPECT_GT(timing.tick.median_ns, 0.0);
  EXPECT_GE(timing.tick.p99_ns, timing.tick.median_ns);
  EXPECT_LE(timing.tick.low_ns, timing.tick.median_ns);
  EXPECT_GE(timing.tick.high_ns, timing.tick.median_ns);
  EXPECT_FALSE(time_models({model}, {{}}).front().measured) << "nothing in contact";
}

}  // namespace
}  // namespace palpate
