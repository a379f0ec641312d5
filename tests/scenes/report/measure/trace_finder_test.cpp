#include "scenes/report/measure/trace_finder.h"

#include <gtest/gtest.h>

#include "tests/support/example_model.h"

namespace palpate {
namespace {

std::vector<ModelPointer> six_models() {
  std::vector<ModelPointer> models;
  for (const ModelData& data : test::example_models()) models.push_back(std::make_shared<const FittedModel>(data));
  models.resize(6, models.front());
  return models;
}

TEST(TraceFinder, KeepsTheWorstSeconds) {
  const std::vector<ModelPointer> six = six_models();
  Recording recording = test::example_recording(20000, 1000.0);
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    recording.rows[i].force_N = i > 12000 && i < 12500 ? 500.0 : 0.0;
  }
  TraceFinder finder(JndLine{}, std::vector<bool>(6, true));
  ASSERT_TRUE(finder.search(recording, six).ok());
  const std::vector<TraceRow>& rows = finder.worst().rows;
  ASSERT_FALSE(rows.empty());
  EXPECT_LE(rows.back().time_s - rows.front().time_s, TraceFinder::kTraceSeconds);
  EXPECT_LE(rows.front().time_s, recording.rows[12499].time_s);
  EXPECT_GE(rows.back().time_s, recording.rows[12001].time_s);
}

}  // namespace
}  // namespace palpate
