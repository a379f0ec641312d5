#include "scenes/report/judge.h"

#include <gtest/gtest.h>

#include "tests/support/example_model.h"

namespace palpate {
namespace {

TEST(BinnedErrors, AreThoseOfAHandfulOfNumbers) {
  BinnedErrors errors(12.0);  // bins of 1 N
  errors.add(0.6, 0.5);
  errors.add(0.2, 0.5);
  errors.add(2.5, 2.5);
  errors.add(0.1, -0.1);
  const std::vector<ErrorBin> bins = errors.bins();
  ASSERT_EQ(bins.size(), 2u) << "empty bins stay out";
  EXPECT_EQ(bins[0].force_from_N, 0.0);
  EXPECT_EQ(bins[0].force_to_N, 1.0);
  EXPECT_EQ(bins[0].count, 3u);
  EXPECT_NEAR(bins[0].mean_abs_error_N, 0.2, 1e-15);
  EXPECT_NEAR(bins[0].std_abs_error_N, std::sqrt(0.02 / 3.0), 1e-15);
  EXPECT_NEAR(bins[0].max_abs_error_N, 0.3, 1e-15);
  EXPECT_EQ(bins[1].force_from_N, 2.0);
  EXPECT_EQ(bins[1].max_abs_error_N, 0.0);
}

std::vector<ModelPointer> example_pointers() {
  std::vector<ModelPointer> models;
  for (const ModelData& data : test::example_models()) models.push_back(std::make_shared<const FittedModel>(data));
  return models;
}

TEST(Jury, PoolsWhatItSawRecordingByRecording) {
  std::vector<ModelPointer> models = example_pointers();
  while (models.size() < 20) models.push_back(models.front());  // more than one replay takes
  const JndLine jnd;
  Jury jury(models.size(), jnd);
  const Recording recording = test::example_recording(500, 1000.0);
  const auto once = jury.judge(recording, models);
  ASSERT_TRUE(once.ok());
  ASSERT_EQ(once->size(), models.size());
  EXPECT_EQ((*once)[0].rms_error_N, (*once)[19].rms_error_N) << "the same model";
  ASSERT_TRUE(jury.judge(recording, models).ok());
  EXPECT_EQ(jury.pooled()[3].samples, 2 * (*once)[3].samples);
  EXPECT_NEAR(jury.pooled()[3].rms_error_N, (*once)[3].rms_error_N, 1e-12);
}

TEST(TraceFinder, KeepsTheWorstSeconds) {
  const std::vector<ModelPointer> six = [] {
    std::vector<ModelPointer> models = example_pointers();
    models.resize(6, models.front());
    return models;
  }();
  Recording recording = test::example_recording(20000, 1000.0);
  for (std::size_t i = 0; i < recording.rows.size(); ++i) {
    recording.rows[i].force_N = i > 12000 && i < 12500 ? 500.0 : 0.0;
  }
  TraceFinder finder{JndLine{}};
  ASSERT_TRUE(finder.look_at(recording, six).ok());
  const std::vector<TraceRow>& rows = finder.worst().rows;
  ASSERT_FALSE(rows.empty());
  EXPECT_LE(rows.back().time_s - rows.front().time_s, TraceFinder::kTraceSeconds);
  EXPECT_LE(rows.front().time_s, recording.rows[12499].time_s);
  EXPECT_GE(rows.back().time_s, recording.rows[12001].time_s);
}

TEST(Thinned, IsEvenlySpread) {
  std::vector<CoveragePoint> points(1000);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].force_N = static_cast<double>(i);
  const auto some = thinned(points, 10);
  ASSERT_EQ(some.size(), 10u);
  EXPECT_EQ(some[3].force_N, 300.0);
  EXPECT_EQ(thinned(points, 2000).size(), 1000u);
}

}  // namespace
}  // namespace palpate
