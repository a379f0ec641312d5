// Hard inputs for the whole fit: each gives a safe model or one clear
// error.
#include "models/fit/fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/correction/methods.h"
#include "models/model/correction.h"
#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using Recordings = std::vector<Recording>;

// What a fit is asked for.
struct Asked {
  TrainingScene scene;
  ModelPlan plan;
};

Asked asked_for(const std::vector<FeatureSpec>& features, Base base = Base::trend) {
  return {{"test", features, {}}, {.base = base, .features = FeatureChoice::scene}};
}

Result<PreparedTraining> prepare(const Recordings& recordings, const Asked& asked, const FitControl& control = {}) {
  std::vector<PreparedRecordingPointer> prepared;
  for (const Recording& recording : recordings) prepared.push_back(prepare_recording(recording));
  auto samples = make_samples(std::move(prepared), asked.scene.jnd, control);
  if (!samples) return samples.error();
  return prepare_training(std::make_shared<const Samples>(std::move(*samples)), asked.scene, asked.plan, control);
}

// The plans of all methods with this base that have the same preparation as `plan`.
std::vector<ModelPlan> plans_like(const ModelPlan& plan) {
  std::vector<ModelPlan> plans;
  for (const ModelPlan& known : all_plans()) {
    if (known.base != plan.base) continue;
    plans.push_back(plan);
    plans.back().method = known.method;
  }
  return plans;
}

// Inside, near and far outside the domain of `data`, forces are finite, negative only if those of
// the training are, and at most 1.2 times the largest training force.
void expect_safe(const ModelData& data) {
  ASSERT_TRUE(write_model_text(data).ok());
  const FittedModel model(data);
  test::Numbers numbers(5);
  for (int i = 0; i < 3000; ++i) {
    std::array<double, kMaxFeatures> x{};
    const double reach = i % 2 == 0 ? 1.0 : 100.0;
    for (std::size_t k = 0; k < data.features.size(); ++k) {
      const auto j = static_cast<Eigen::Index>(k);
      x[k] = data.offset(j) + reach * data.scale(j) * 2.0 * numbers.next();
    }
    const double force_N = model.evaluate(x.data()).force_N;
    ASSERT_TRUE(force_N >= data.lowest_force_N && force_N <= kForceMargin * data.largest_force_N) << force_N;
  }
}

// Fits every method. Each model must have at least the share `least_within` of the training samples within the JND.
void expect_all_methods(const Recordings& recordings, Asked asked, double least_within) {
  const auto prepared = prepare(recordings, asked);
  ASSERT_TRUE(prepared.ok()) << prepared.error().message;
  asked.plan.centres = 40;
  asked.plan.grid.assign(prepared->common.features.size(), 5);
  for (const ModelPlan& plan : plans_like(asked.plan)) {
    const auto fit = fit_method(*prepared, plan);
    ASSERT_TRUE(fit.ok()) << plan_name(plan) << ": " << fit.error().message;
    expect_safe(fit->data);
    EXPECT_GE(fit->data.provenance.training_within_jnd, least_within) << plan_name(plan);
  }
}

Recording constant(int rows, double position_m, double force_N) {
  Recording recording;
  recording.name = "constant";
  for (int i = 0; i < rows; ++i) recording.rows.push_back({1e-3 * i, position_m, force_N, 0.0, 0.0});
  return recording;
}

// A recording of 1,000 rows at 250 Hz with these forces.
template <typename Force>
Recording with_forces(Force force_N) {
  Recording recording = test::example_recording(1000, 250.0);
  for (RecordingRow& row : recording.rows) row.force_N = force_N(row.force_N);
  return recording;
}

TEST(Fit, EveryMethodFitsEveryRecording) {
  Recording one_in_contact = constant(20, -1e-3, 0.0);
  one_in_contact.rows[10].position_m = 1e-3;
  one_in_contact.rows[10].force_N = 0.5;
  Recording even;
  for (int i = 0; i < 1000; ++i) even.rows.push_back({1e-3 * i, 4e-6 * i, 1.2e-3 * i, 0.0, 0.0});
  struct Row {
    const char* name;
    Recording recording;
    bool position_alone;
    double least_within;
  };
  const Row rows[] = {
      {"ordinary", test::example_recording(1500, 250.0), false, 0.9},
      {"position alone", test::example_recording(1500, 250.0), true, 0.5},
      {"one sample in contact", one_in_contact, false, 0.0},
      {"one sample in contact, position alone", one_in_contact, true, 0.0},
      {"all samples identical", constant(500, 2e-3, 1.0), false, 1.0},
      {"all samples identical, position alone", constant(500, 2e-3, 1.0), true, 1.0},
      {"all forces zero", with_forces([](double) { return 0.0; }), false, 1.0},
      {"all forces equal", with_forces([](double) { return 1.0; }), false, 0.5},
      {"negative forces", with_forces([](double force_N) { return -std::abs(force_N); }), false, 0.0},
      {"a constant velocity", even, false, 0.95},
      {"10 Hz", test::example_recording(400, 10.0), false, 0.3},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(row.name);
    const auto features = row.position_alone ? test::position_features() : test::paper_features();
    expect_all_methods({row.recording}, asked_for(features), row.least_within);
    // The paper's methods promise no share; the model must be safe.
    expect_all_methods({row.recording}, asked_for(features, Base::force), 0.0);
  }
}

TEST(Fit, SeveralRecordingsAndOneTwice) {
  const Recording a = test::example_recording(1000, 250.0);
  const Recording b = test::example_recording(600, 500.0);
  const auto prepared = prepare({a, b, a}, asked_for(test::paper_features()));
  ASSERT_TRUE(prepared.ok());
  EXPECT_EQ(prepared->common.provenance.samples, 2600u);
  EXPECT_EQ(prepared->common.provenance.recordings.size(), 3u);
  expect_all_methods({a, b, a}, asked_for(test::paper_features()), 0.8);
}

TEST(Fit, EveryKernelAndThinning) {
  const Recording recording = test::example_recording(800, 250.0);
  for (const Thinning thinning : {Thinning::coverage, Thinning::force, Thinning::none}) {
    Asked asked = asked_for(test::paper_features());
    asked.plan.thinning = thinning;
    asked.plan.centres = 30;
    for (const KernelKind kernel : kKernelKinds) {
      asked.plan.kernel = kernel;
      auto prepared = prepare({recording}, asked);
      ASSERT_TRUE(prepared.ok());
      prepared->correction->used = true;  // a correction regardless of cross-validation
      const auto fit = fit_method(*prepared, asked.plan);
      ASSERT_TRUE(fit.ok()) << fit.error().message;
      EXPECT_EQ(rbf_of(fit->data.correction)->kernel, kernel);
      EXPECT_EQ(fit->kernel, kernel);
      EXPECT_GT(fit->rank, 1);
      EXPECT_GE(fit->condition_number, 1.0);
      expect_safe(fit->data);
    }
  }
}

TEST(Fit, EachRefusalSaysWhy) {
  const Recording recording = test::example_recording(1000, 1000.0);
  EXPECT_TRUE(test::has_parts(prepare({constant(50, -1e-3, 0.0)}, asked_for(test::paper_features())).error().message,
                              {"in contact (position_m > 0)", "; ", "palpate import FILE --zero contact"}));
  Asked voxel = asked_for(test::paper_features());
  auto prepared = prepare({recording}, voxel);
  ASSERT_TRUE(prepared.ok());
  prepared->correction->used = true;
  voxel.plan.method = &kVoxelMethod;
  voxel.plan.grid = {5, 5};
  EXPECT_TRUE(test::has_parts(fit_method(*prepared, voxel.plan).error().message, {"2", "4", "--grid 25x11x11x11"}));
  voxel.plan.grid = {5, 5, 1, 5};
  EXPECT_TRUE(test::has_parts(fit_method(*prepared, voxel.plan).error().message, {"2", "1"}));
  voxel.plan.grid = {1000, 1000, 1000, 1000};
  EXPECT_TRUE(test::has_parts(fit_method(*prepared, voxel.plan).error().message, {"1e+12", "1e7", "; "}));
}

// Returning false from any progress call interrupts the fit.
TEST(Fit, StopsWhereverItIsAsked) {
  const Recording recording = test::example_recording(70000, 5000.0);
  for (const Base base : {Base::trend, Base::force}) {
    Asked asked = asked_for(test::paper_features(), base);
    int questions = 0;
    const auto prepared = prepare({recording}, asked, {[&](double) { return ++questions > 0; }});
    ASSERT_TRUE(prepared.ok());
    // Two in each pass over 70,000 rows, of which the trend has two more, and two after them.
    ASSERT_EQ(questions, base == Base::trend ? 8 : 6);
    for (int stop = 1; stop <= questions; ++stop) {
      int count = 0;
      const auto stopped = prepare({recording}, asked, {[&](double) { return ++count < stop; }});
      EXPECT_EQ(test::message_of(stopped), "interrupted") << stop;
    }
    for (const ModelPlan& plan : plans_like(asked.plan))
      EXPECT_EQ(test::message_of(fit_method(*prepared, plan, {[](double) { return false; }})), "interrupted")
          << plan_name(plan);
    asked.plan.method = &kRandomMethod;
    questions = 0;
    ASSERT_TRUE(fit_method(*prepared, asked.plan, {[&](double) { return ++questions > 0; }}).ok());
    for (int stop = 1; stop <= questions; ++stop) {
      int count = 0;
      const auto stopped = fit_method(*prepared, asked.plan, {[&](double) { return ++count < stop; }});
      EXPECT_EQ(test::message_of(stopped), "interrupted") << stop;
    }
  }
}

TEST(Fit, ACorrectionThatIsRejectedLeavesTheTrend) {
  Asked asked = asked_for(test::paper_features());
  auto prepared = prepare({test::example_recording(1000, 250.0)}, asked);
  ASSERT_TRUE(prepared.ok());
  prepared->correction->used = false;
  for (const ModelPlan& plan : plans_like(asked.plan)) {
    const auto fit = fit_method(*prepared, plan);
    ASSERT_TRUE(fit.ok());
    EXPECT_EQ(fit->data.name, "trend");
    EXPECT_EQ(fit->data.method, "trend");
    EXPECT_EQ(fit->data.correction, nullptr);
  }
}

// The model has the normalisation, kernel and truncation that were selected, and its notes say so.
TEST(Fit, OnTheForceUsesWhatIsSelected) {
  Asked asked = asked_for(test::paper_features(), Base::force);
  const auto prepared = prepare({test::example_recording(1500, 250.0)}, asked);
  ASSERT_TRUE(prepared.ok());
  asked.plan.method = &kRandomMethod;
  asked.plan.centres = 30;
  OpenChoices choices{KernelKind::linear, 1.0, 1e-6, 0.0, 0.5};
  const auto fit = fit_method(*prepared, asked.plan, {}, nullptr, &choices);
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_EQ(fit->data.name, "random-30");
  EXPECT_EQ(fit->data.scale, prepared->common.scale_of(1.0));
  EXPECT_EQ(fit->kernel, KernelKind::linear);
  EXPECT_LT(fit->condition_number, 1e6);
  ASSERT_EQ(fit->notes.size(), 1u);
  EXPECT_EQ(fit->notes[0], choices_text(choices));
  expect_safe(fit->data);
  // Centres are sites in the new normalisation.
  const Eigen::MatrixXd& centres = rbf_of(fit->data.correction)->centres;
  const Eigen::MatrixXd sites =
      prepared->common.scale.cwiseQuotient(fit->data.scale).asDiagonal() * prepared->sites.points;
  for (Eigen::Index j = 0; j < centres.cols(); ++j)
    EXPECT_EQ((sites.colwise() - centres.col(j)).colwise().norm().minCoeff(), 0.0);
  const auto selected = fit_method(*prepared, asked.plan);
  ASSERT_TRUE(selected.ok());
  ASSERT_TRUE(selected->choices.has_value());
  EXPECT_EQ(selected->data.scale, prepared->common.scale_of(selected->choices->range_exponent));
  EXPECT_EQ(rbf_of(selected->data.correction)->kernel, selected->choices->kernel);
}

}  // namespace
}  // namespace palpate
