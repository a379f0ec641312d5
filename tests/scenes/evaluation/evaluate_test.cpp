#include "scenes/evaluation/evaluate.h"

#include <gtest/gtest.h>

#include "engine/tick/motion_estimator.h"
#include "scenes/material/rig.h"
#include "tests/support/example_model.h"
#include "tests/support/fitting.h"
#include "tests/support/message_parts.h"

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
  while (models.size() < 20) models.push_back(example_list().front());
  const Recording recording = test::example_recording(500, 1000.0);
  int rows = 0;
  EvaluationRequest request;
  request.also = [&](const RecordingRow&, const TickSnapshot& snapshot, const HapticsTick&) {
    ++rows;
    EXPECT_EQ(snapshot.model_count, 16u);
  };
  const auto result = test::must(evaluate(recording, models, request));
  ASSERT_EQ(result.models.size(), 20u);
  EXPECT_EQ(result.samples, 500u);
  EXPECT_EQ(rows, 500);
  const ErrorSummary first = result.models[0].as_recorded.summary();
  const ErrorSummary last = result.models[19].as_recorded.summary();
  EXPECT_EQ(first.samples, result.no_force.summary().samples);
  EXPECT_EQ(first.rms_error_N, last.rms_error_N) << "the same model";
  EXPECT_EQ(first.rms_error_N == result.models[0].surface_moved.summary().rms_error_N,
            result.models[0].surfaces[0].at == 0.0);
}

TEST(Evaluate, EveryModelHasItsOwnDomain) {
  const Recording recording = test::example_recording(800, 1000.0);
  std::vector<EvaluatedModel> models;
  for (const double share : {0.3, 1.0, 0.6}) {
    ModelData data = test::example_models().front();
    data.upper *= share;
    models.push_back({std::make_shared<const FittedModel>(data), data.jnd});
  }
  const auto together = test::must(evaluate(recording, models));
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto alone = test::must(evaluate(recording, {models[i]}));
    EXPECT_EQ(together.models[i].as_recorded.summary().out_of_domain_samples,
              alone.models[0].as_recorded.summary().out_of_domain_samples);
  }
  EXPECT_GT(together.models[0].as_recorded.summary().out_of_domain_samples,
            together.models[1].as_recorded.summary().out_of_domain_samples);
}

TEST(Evaluate, RecordingsArePooledWithASurfaceEach) {
  const Recording first = test::example_recording(800, 1000.0);
  Recording second = test::example_recording(600, 1000.0);
  for (RecordingRow& row : second.rows) row.position_m += 0.3e-3;
  const auto one = test::must(evaluate(first, example_list()));
  const auto other = test::must(evaluate(second, example_list()));
  const auto both = test::must(evaluate(second, example_list(), {}, one));
  EXPECT_EQ(both.samples, 1400u);
  ASSERT_EQ(both.timing.size(), 2u);
  for (std::size_t i = 0; i < both.models.size(); ++i) {
    const ModelEvaluation& pooled = both.models[i];
    ASSERT_EQ(pooled.surfaces.size(), 2u);
    EXPECT_EQ(pooled.surfaces[0].at, one.models[i].surfaces[0].at);
    EXPECT_EQ(pooled.surfaces[1].at, other.models[i].surfaces[0].at);
    for (const auto& errors : {&ModelEvaluation::as_recorded, &ModelEvaluation::surface_moved}) {
      const ErrorSummary whole = (pooled.*errors).summary();
      const ErrorSummary parts[] = {(one.models[i].*errors).summary(), (other.models[i].*errors).summary()};
      EXPECT_EQ(whole.samples, parts[0].samples + parts[1].samples);
      EXPECT_EQ(whole.max_error_N, std::max(parts[0].max_error_N, parts[1].max_error_N));
    }
  }
}

// A recording that begins under a preload of 1 N as the training did, 10 mm from there.
TEST(Evaluate, TheSamePreloadElsewhereIsAColumnOfItsOwn) {
  ModelData data = test::example_models().front();
  data.ends = {{-9e-3, -50e-3, std::vector<double>(memory_size(data.features)), 1.05}};
  const std::vector<EvaluatedModel> models{{std::make_shared<const FittedModel>(data), data.jnd}};
  Recording recording = test::example_recording(800, 1000.0);
  for (RecordingRow& row : recording.rows) row.position_m += 1e-3 - recording.rows.front().position_m;
  const auto offset_m = [&](double first_N) {
    recording.rows.front().force_N = first_N;
    return preload_offset_m(recording, models.front());
  };
  EXPECT_DOUBLE_EQ(offset_m(1.0), 10e-3);
  EXPECT_EQ(offset_m(0.1), 0.0) << "no preload";
  EXPECT_EQ(offset_m(1.6), 0.0) << "another preload: three JND are 0.5 N";
  recording.rows.front().force_N = 1.0;
  EvaluationRequest request;
  EXPECT_EQ(test::must(evaluate(recording, models, request)).models[0].beginning_moved.summary().samples, 0u);
  request.move_beginning = true;
  const auto found = test::must(evaluate(recording, models, request));
  EXPECT_DOUBLE_EQ(found.models[0].beginning_m, 10e-3);
  for (RecordingRow& row : recording.rows) row.position_m -= 10e-3;
  const auto there = test::must(evaluate(recording, models));
  EXPECT_EQ(found.models[0].beginning_moved.summary().samples, there.models[0].as_recorded.summary().samples);
  EXPECT_NEAR(found.models[0].beginning_moved.summary().rms_error_N, there.models[0].as_recorded.summary().rms_error_N,
              1e-9);
}

TEST(ModelErrors, CountErrorsWithinTheBoundAndKnowWhenItSaysNothing) {
  const JndLine jnd{0.1, 0.0};
  ModelErrors errors(jnd);
  EXPECT_FALSE(errors.summary().bound.has_bounds());
  errors.add(1.0, 1.0, false);
  EXPECT_FALSE(errors.summary().bound.has_bounds()) << "a model without bounds";
  for (const double error_N : {0.0, 0.1, 0.2, 0.3}) errors.add(1.0 + error_N, 1.0, false, 0.25);
  EXPECT_EQ(errors.summary().bound.coverage, 0.75);
  EXPECT_NEAR(errors.summary().bound.median_N, 0.25, 1e-7);
  EXPECT_NEAR(errors.summary().bound.median_over_jnd, 2.5, 1e-6);
  for (int i = 0; i < 7; ++i) errors.add(1.0, -1.5, false, 2.0);
  EXPECT_EQ(errors.summary().bound.coverage, 3.0 / 11.0);
  EXPECT_EQ(errors.summary().bound.median_N, 2.0);
  EXPECT_TRUE(std::isnan(errors.summary().bound.median_over_jnd)) << "wider than the largest force, 1.5 N";
  ModelErrors pulling(jnd);
  pulling.add(0.0, -1.5, false, 1.25);
  EXPECT_NEAR(pulling.summary().bound.median_over_jnd, 12.5, 1e-6)
      << "the largest force is that of a material that pulls";
}

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

Recording shorter(RigSettings settings, std::uint64_t seed) {
  settings.seed = seed;
  settings.seconds = 12.0;
  return *test::rig_recording(settings);
}

std::vector<Sample> moved(const Recording& recording, double offset_m) {
  Recording copy = recording;
  for (RecordingRow& row : copy.rows) row.position_m += offset_m;
  return thinned_rows(copy, kSearchRows);
}

// Offsets of any size. Gel is left out: its slowest branch is longer than these recordings (error 0.035 mm).
TEST(SurfaceSearch, FindsTheShiftOfATestRecording) {
  for (const char* material : {"silicone", "foam", "maxwell"}) {
    const auto training = std::make_shared<const Recording>(shorter(test::train_settings(material), 1));
    const auto prepared = test::prepare({training}, test::default_request("silicone_block"));
    const std::vector<std::shared_ptr<const ForceModel>> models{test::fit(prepared, &kGreedyMethod),
                                                                test::fit(prepared, &kRandomMethod)};
    const Recording recording = shorter(test::test_settings(material), 2);
    for (const double shift_m : {-12e-3, -1.4e-3, -0.5e-3, 0.0, 0.3e-3, 5e-3}) {
      const OffsetEstimate found = locate_surface(moved(recording, shift_m), models, JndLine{});
      EXPECT_NEAR(found.at, shift_m, 0.03e-3) << material;
      EXPECT_TRUE(found.identified) << material;
    }
  }
}

}  // namespace
}  // namespace palpate
