#include "scenes/evaluation/model_timing.h"

#include <gtest/gtest.h>

#include "engine/tick/sensor_identification.h"
#include "tests/support/example_model.h"

namespace palpate {
namespace {

// Runs stay whole and evenly spread, whatever the length of the stream.
TEST(TimingSample, IsBoundedAndSpreadOverTheWholeStream) {
  constexpr std::size_t kBlock = TimingSample::kBlock;
  TimingSample sample;
  const std::size_t total = kBlock * TimingSample::kMaximumBlocks * 5 + 13;
  for (std::size_t i = 0; i < total; ++i) sample.add({1e-3 * static_cast<double>(i), static_cast<double>(i)});
  const std::vector<ToolSample>& kept = sample.samples();
  EXPECT_LE(kept.size(), kBlock * TimingSample::kMaximumBlocks);
  EXPECT_GT(kept.back().position_m, 0.9 * static_cast<double>(total));
  for (std::size_t i = 0; i < kept.size(); ++i) {
    ASSERT_EQ(kept[i].position_m, static_cast<double>(i / kBlock * kBlock * 8 + i % kBlock));
  }
}

TEST(ModelTiming, MeasuresTheTickAndTheEvaluationInIt) {
  const Recording recording = test::example_recording(1000, 1000.0);
  TimingSample sample;
  for (const RecordingRow& row : recording.rows) {
    if (row.position_m > 0.0) sample.add(tool_sample(row));
  }
  const auto model = std::make_shared<const FittedModel>(test::example_models().front());
  const ModelTiming timing = time_model(model, {}, sample);
  EXPECT_TRUE(timing.measured);
  EXPECT_GT(timing.evaluation.median_ns, 0.0);
  EXPECT_GT(timing.tick.median_ns, 0.0);
  EXPECT_GE(timing.tick.p99_ns, timing.tick.median_ns);
  EXPECT_FALSE(time_model(model, {}, {}).measured) << "nothing in contact";
}

}  // namespace
}  // namespace palpate
