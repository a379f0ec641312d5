#include "scenes/evaluation/evaluate.h"

#include <gtest/gtest.h>

#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

std::vector<EvaluatedModel> example_list() {
  std::vector<EvaluatedModel> models;
  for (const ModelData& data : test::example_models()) {
    models.push_back({std::make_shared<const FittedModel>(data), data.jnd});
  }
  return models;
}

TEST(Evaluate, TakesMoreModelsThanOneTick) {
  std::vector<EvaluatedModel> models = example_list();
  while (models.size() < 20) models.push_back(models.front());
  const Recording recording = test::example_recording(500, 1000.0);
  int rows = 0;
  EvaluationRequest request;
  request.also = [&](const RecordingRow&, const TickSnapshot& snapshot, const HapticsTick&) {
    ++rows;
    EXPECT_EQ(snapshot.model_count, 16u);
  };
  const auto result = test::must(evaluate(rows_of(recording), models, request));
  ASSERT_EQ(result.models.size(), 20u);
  EXPECT_EQ(result.samples, 500u);
  EXPECT_EQ(rows, 500);
  const ErrorSummary first = result.models[0].as_recorded.summary();
  const ErrorSummary last = result.models[19].as_recorded.summary();
  EXPECT_EQ(first.samples, result.contact_samples);
  EXPECT_EQ(first.rms_error_N, last.rms_error_N) << "the same model";
  EXPECT_EQ(first.rms_error_N == result.models[0].surface_moved.summary().rms_error_N,
            result.models[0].surface.at == 0.0);
}

TEST(Evaluate, EveryModelHasItsOwnDomain) {
  const Recording recording = test::example_recording(800, 1000.0);
  std::vector<EvaluatedModel> models;
  for (const double share : {0.3, 1.0, 0.6}) {
    ModelData data = test::example_models().front();
    data.upper *= share;
    models.push_back({std::make_shared<const FittedModel>(data), data.jnd});
  }
  const auto together = test::must(evaluate(rows_of(recording), models));
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto alone = test::must(evaluate(rows_of(recording), {models[i]}));
    EXPECT_EQ(together.models[i].as_recorded.summary().out_of_domain_samples,
              alone.models[0].as_recorded.summary().out_of_domain_samples);
  }
  EXPECT_GT(together.models[0].as_recorded.summary().out_of_domain_samples,
            together.models[1].as_recorded.summary().out_of_domain_samples);
}

TEST(Evaluate, AFileAndItsRecordingGiveTheSame) {
  const Recording recording = test::example_recording(800, 1000.0);
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_recording(folder.file("r.csv"), recording, {}, false).ok());
  const auto memory = evaluate(rows_of(recording), example_list());
  const auto file = evaluate(rows_of_file(folder.file("r.csv")), example_list());
  ASSERT_TRUE(memory.ok() && file.ok());
  EXPECT_EQ(file->models[2].as_recorded.summary().rms_error_N, memory->models[2].as_recorded.summary().rms_error_N);
  EXPECT_EQ(file->models[2].surface.at, memory->models[2].surface.at);
  EXPECT_FALSE(evaluate(rows_of_file(folder.file("none.csv")), example_list()).ok());
}

TEST(Evaluate, SamplesThatAreNotCountedAreReplayed) {
  const Recording recording = test::example_recording(800, 1000.0);
  std::uint64_t counted = 0;
  double largest_N = 0.0;  // error of the first model
  EvaluationRequest request;
  request.counted_from_s = recording.rows[400].time_s;
  request.also = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
    if (row.time_s < request.counted_from_s || !snapshot.in_contact) return;
    ++counted;
    largest_N = std::max(largest_N, std::abs(snapshot.force_N[0] - row.force_N));
  };
  const auto result = test::must(evaluate(rows_of(recording), example_list(), request));
  EXPECT_EQ(result.samples, 800u);
  EXPECT_GT(counted, 0u);
  EXPECT_EQ(result.contact_samples, counted);
  EXPECT_EQ(result.models[0].as_recorded.summary().max_error_N, largest_N);
}

TEST(Evaluate, NoForceErrsByTheWholeForce) {
  const Recording recording = test::example_recording(300, 1000.0);
  const auto result = test::must(evaluate(rows_of(recording), example_list()));
  double largest_N = 0.0;
  for (const RecordingRow& row : recording.rows) {
    if (row.position_m > 0.0) largest_N = std::max(largest_N, std::abs(row.force_N));
  }
  EXPECT_EQ(result.no_force.summary().max_error_N, largest_N);
}

TEST(BoundErrors, CountErrorsWithinTheBoundAndKnowWhenItSaysNothing) {
  const JndLine jnd{0.1, 0.0};
  BoundErrors bounds;
  EXPECT_FALSE(bounds.figures().has_bounds());
  bounds.add(kUnknown, 1.0, 1.0, jnd);
  EXPECT_FALSE(bounds.figures().has_bounds()) << "a model without bounds";
  for (const double error_N : {0.0, 0.1, 0.2, 0.3}) bounds.add(0.25, 1.0 + error_N, 1.0, jnd);
  EXPECT_EQ(bounds.figures().coverage, 0.75);
  EXPECT_NEAR(bounds.figures().median_N, 0.25, 1e-7);
  EXPECT_NEAR(bounds.figures().median_over_jnd, 2.5, 1e-6);
  BoundErrors wide;
  for (int i = 0; i < 7; ++i) wide.add(2.0, 1.0, -1.5, jnd);
  bounds.append(wide);
  EXPECT_EQ(bounds.figures().coverage, 3.0 / 11.0);
  EXPECT_EQ(bounds.figures().median_N, 2.0);
  EXPECT_TRUE(std::isnan(bounds.figures().median_over_jnd)) << "wider than the largest force, 1.5 N";
  BoundErrors pulling;
  pulling.add(1.25, 0.0, -1.5, jnd);
  EXPECT_NEAR(pulling.figures().median_over_jnd, 12.5, 1e-6) << "the largest force is that of a material that pulls";
}

}  // namespace
}  // namespace palpate
