#include "models/fit/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/tick/haptics_tick.h"
#include "models/model/correction.h"
#include "models/model/file/model_io.h"
#include "scenes/evaluation/model_errors.h"
#include "tests/support/example_model.h"
#include "tests/support/fitting.h"
#include "tests/support/message_parts.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

// Hard inputs for the whole fit: each gives a safe model or one clear
// error.

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
  const Result prepared = test::must(prepare(recordings, asked));
  asked.plan.centres = 40;
  asked.plan.grid.assign(prepared->common.features.size(), 5);
  for (const ModelPlan& plan : plans_like(asked.plan)) {
    const auto fit = fit_method(*prepared, plan);
    ASSERT_TRUE(fit.ok()) << plan_name(plan) << ": " << fit.error().message;
    expect_safe(fit->model->data());
    EXPECT_GE(fit->model->data().provenance.training_within_jnd, least_within) << plan_name(plan);
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
      const Result fit = test::must(fit_method(*prepared, asked.plan));
      EXPECT_EQ(rbf_of(fit->model->data().correction)->kernel, kernel);
      EXPECT_EQ(fit->kernel, kernel);
      EXPECT_GT(fit->rank, 1);
      EXPECT_GE(fit->condition_number, 1.0);
      expect_safe(fit->model->data());
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
    const Result fit = test::must(fit_method(*prepared, plan));
    EXPECT_EQ(fit->model->data().name, "trend");
    EXPECT_EQ(fit->model->data().method, "trend");
    EXPECT_EQ(fit->model->data().correction, nullptr);
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
  EXPECT_EQ(fit->model->data().name, "random-30");
  EXPECT_EQ(fit->model->data().scale, prepared->common.scale_of(1.0));
  EXPECT_EQ(fit->kernel, KernelKind::linear);
  EXPECT_LT(fit->condition_number, 1e6);
  ASSERT_EQ(fit->notes.size(), 1u);
  EXPECT_EQ(fit->notes[0], choices_text(choices));
  expect_safe(fit->model->data());
  // Centres are sites in the new normalisation.
  const Eigen::MatrixXd& centres = rbf_of(fit->model->data().correction)->centres;
  const Eigen::MatrixXd sites =
      prepared->common.scale.cwiseQuotient(fit->model->data().scale).asDiagonal() * prepared->sites.points;
  for (Eigen::Index j = 0; j < centres.cols(); ++j)
    EXPECT_EQ((sites.colwise() - centres.col(j)).colwise().norm().minCoeff(), 0.0);
  const Result selected = test::must(fit_method(*prepared, asked.plan));
  ASSERT_TRUE(selected->choices.has_value());
  EXPECT_EQ(selected->model->data().scale, prepared->common.scale_of(selected->choices->range_exponent));
  EXPECT_EQ(rbf_of(selected->model->data().correction)->kernel, selected->choices->kernel);
}

using test::must;

ModelFits example_fits() {
  return ModelFits({prepare_recording(test::example_recording(1500, 250.0)),
                    prepare_recording(test::example_recording(1000, 250.0))},
                   {"test", test::paper_features(), {}});
}

// A plan with the features of the scene.
ModelPlan plan_for(Base base, const Method& method, int centres = 30) {
  return {.base = base, .method = &method, .centres = centres, .features = FeatureChoice::scene};
}

// The model of a plan, and the number of questions of its fit: fewer if parts are reused.
std::pair<std::string, int> counted(ModelFits& fits, const ModelPlan& plan) {
  int questions = 0;
  const auto fit = must(fits.fit(plan, {[&](double) { return ++questions > 0; }}));
  return {must(write_model_text(fit.model->data())), questions};
}

TEST(ModelFits, PlansThatDifferInTheMethodShareTheirPreparation) {
  ModelFits fits = example_fits();
  const PreparedTraining* const first = must(fits.prepare(plan_for(Base::trend, kGreedyMethod), {}));
  EXPECT_EQ(must(fits.prepare(plan_for(Base::trend, kDirectMethod), {})), first);
  EXPECT_EQ(must(fits.prepare(plan_for(Base::trend, kGreedyMethod, 7), {})), first);
  const PreparedTraining* const on_force = must(fits.prepare(plan_for(Base::force, kGreedyMethod), {}));
  EXPECT_NE(on_force, first);
  ModelPlan other = plan_for(Base::trend, kGreedyMethod);
  other.thinning = Thinning::none;
  EXPECT_NE(must(fits.prepare(other, {})), first);
  other.thinning = Thinning::coverage;
  EXPECT_EQ(must(fits.prepare(other, {})), first) << "coverage is the default with the trend";
  // The kernel belongs to the residual of the trend, but not to the force.
  other.kernel = KernelKind::linear;
  EXPECT_NE(must(fits.prepare(other, {})), first);
  other.base = Base::force;
  other.thinning.reset();
  EXPECT_EQ(must(fits.prepare(other, {})), on_force);
  // Every preparation has the same samples, and stays valid.
  EXPECT_EQ(first->samples, on_force->samples);
  EXPECT_EQ(first->samples, must(fits.samples({})));
  EXPECT_EQ(must(fits.prepare(plan_for(Base::trend, kGreedyMethod), {})), first);
}

TEST(ModelFits, AFitIsThatOfAPlanAlone) {
  for (const Base base : {Base::trend, Base::force}) {
    ModelFits shared = example_fits();
    for (const Method* method : {&kDirectMethod, &kVoxelMethod, &kRandomMethod, &kGreedyMethod}) {
      const ModelPlan plan = plan_for(base, *method);
      ModelFits alone = example_fits();
      EXPECT_EQ(counted(shared, plan).first, counted(alone, plan).first) << plan_name(plan);
    }
  }
}

using test::RecordingPtr;

RecordingPtr rig(const std::string& material, std::uint64_t seed, double offset_m = 0.0) {
  RigSettings settings = test::train_settings(material);
  settings.seed = seed;
  settings.seconds = 12.0 + static_cast<double>(seed);
  auto copy = std::make_shared<Recording>(*test::rig_recording(settings));
  for (RecordingRow& row : copy->rows) row.position_m += offset_m;
  return copy;
}

TEST(PrepareOnTheForce, FitsTwoTimesToTheRecording) {
  const test::FitRequest request = test::on_the_force(test::default_request("silicone_block"));
  RigSettings settings = test::train_settings("foam");  // 0.08 and 0.9 s, unlike the times of the scene
  settings.seconds = 15.0;
  const PreparedTraining prepared = test::prepare({test::rig_recording(settings)}, request);
  const std::vector<double> times_s = relaxation_times_s(prepared.common.features);
  ASSERT_EQ(times_s.size(), 2u);
  EXPECT_LT(times_s[0], times_s[1]);
  EXPECT_NE(times_s, relaxation_times_s(request.scene.features));
  std::size_t low_pass = 0;
  for (const FeatureSpec& spec : prepared.common.features) low_pass += spec.kind == FeatureKind::lowpass_velocity;
  EXPECT_EQ(low_pass, 2u);
  const Provenance& provenance = prepared.common.provenance;
  EXPECT_EQ(provenance.thinning, "force");
  EXPECT_EQ(provenance.weighting, "relative");
  EXPECT_EQ(provenance.relaxation, "auto");
}

// A porous solid under cyclic presses: the pressure of its fluid relaxes within times of 4 s / (2 n + 1)^2, and acts on
// an area that grows with the depth, so that contact is lost while the tool retreats.
RecordingPtr porous_presses(double frequency_per_s, double depth_m, double seconds) {
  auto recording = std::make_shared<Recording>();
  recording->name = "porous " + std::to_string(frequency_per_s);
  std::array<double, 8> pressure_m{};
  double last_m = 0.0;
  for (int i = 0; 2e-3 * i < seconds; ++i) {
    const double time_s = 2e-3 * i;
    const double position_m =
        -0.5e-3 + (depth_m + 0.5e-3) * 0.5 * (1.0 - std::cos(2.0 * std::numbers::pi * frequency_per_s * time_s));
    const double x_m = std::max(0.0, position_m);
    double sum_m = 0.0;
    for (std::size_t n = 0; n < pressure_m.size(); ++n) {
      const double odd = 2.0 * static_cast<double>(n) + 1.0;
      const double share = 8.0 / (std::numbers::pi * std::numbers::pi * odd * odd);
      pressure_m[n] = pressure_m[n] * std::exp(-2e-3 * odd * odd / 4.0) + share * (x_m - last_m);
      sum_m += pressure_m[n];
    }
    last_m = x_m;
    const double force_N = 800.0 * x_m * (1.0 + 200.0 * x_m) + 2000.0 * sum_m * (1.0 + 150.0 * x_m);
    // Pseudo-noise of 8 mN.
    const double noise_N = 11e-3 * std::sin(977.0 * time_s * time_s + 12.9 * time_s);
    recording->rows.push_back(
        {time_s, position_m, (position_m > 0.0 ? std::max(0.0, force_N) : 0.0) + noise_N, 0.0, 0.0});
  }
  return recording;
}

// The faster a press, the stiffer the solid: no offset explains that.
TEST(PrepareTraining, FrequenciesOfAPorousSolidAreNoOffsets) {
  const std::vector<RecordingPtr> recordings{porous_presses(0.2, 4e-3, 20.0), porous_presses(1.0, 4e-3, 10.0),
                                             porous_presses(0.5, 2e-3, 10.0)};
  const PreparedTraining prepared = test::prepare(recordings, test::default_request("silicone_block"));
  for (const auto& offset : prepared.common.provenance.offsets) EXPECT_EQ(offset.offset_m, 0.0) << offset.name;
  const test::ModelPtr model = test::fit(prepared, &kTrendMethod);
  // 0.84; with offsets of some tenths of a millimetre 0.68.
  EXPECT_GT(test::judge(*porous_presses(0.4, 3.5e-3, 15.0), model).within_jnd, 0.8);
}

std::string model_of(const std::vector<RecordingPtr>& recordings, const Method* method) {
  const auto model = test::fit(test::prepare(recordings, test::scene_request("silicone_block")), method);
  return test::must(write_model_text(model->data()));
}

TEST(PrepareTraining, TheOrderOfRecordingsChangesNoByteOfTheModel) {
  const RecordingPtr a = rig("silicone", 1);
  const RecordingPtr b = rig("silicone", 2, 2e-3);
  const RecordingPtr c = rig("foam", 2, -0.1e-3);
  const std::string model = model_of({a, b, c}, &kKdTreeMethod);
  EXPECT_EQ(model_of({c, a, b}, &kKdTreeMethod), model);
  EXPECT_EQ(model_of({b, c, a}, &kKdTreeMethod), model);
}

TEST(PrepareTraining, ASiteCountsAsItsSamplesAndAModelSaysWhereItsRecordingsWere) {
  const auto prepared =
      test::prepare({rig("maxwell", 2, 0.5e-3), rig("maxwell", 3)}, test::scene_request("silicone_block"));
  EXPECT_GT(prepared.sites.samples.maxCoeff(), 16.0);
  for (Eigen::Index i = 0; i < prepared.sites.count(); ++i) {
    const double samples = std::min(prepared.sites.samples(i), 16.0);
    EXPECT_DOUBLE_EQ(prepared.sites.row_scale(i), std::sqrt(samples) / JndLine{}.at(prepared.sites.force_N(i)));
  }
  const auto& offsets = prepared.common.provenance.offsets;
  ASSERT_EQ(offsets.size(), 2u);
  // The accuracy of each surface is 0.02 mm.
  EXPECT_NEAR(offsets[1].offset_m - offsets[0].offset_m, 0.5e-3, 0.05e-3);
  const auto model = test::fit(prepared, &kRandomMethod);
  const ModelData back = test::must(read_model_text(test::must(write_model_text(model->data())), "m.json"));
  ASSERT_EQ(back.provenance.offsets.size(), 2u);
  EXPECT_EQ(back.provenance.offsets[1].offset_m, offsets[1].offset_m);
  EXPECT_EQ(back.provenance.offsets[1].standard_error_m, offsets[1].standard_error_m);
  EXPECT_EQ(back.provenance.offsets[1].force_zero_N, offsets[1].force_zero_N);
}

// Two recordings with the same name: each has its own offset.
TEST(PrepareTraining, OffsetsAreKnownByTheContentOfTheirRecordings) {
  std::vector<RecordingPtr> recordings;
  for (const double offset_m : {0.5e-3, 0.0}) {
    Recording one = *rig("maxwell", recordings.empty() ? 2 : 3, offset_m);
    one.name = "press";
    recordings.push_back(std::make_shared<const Recording>(std::move(one)));
  }
  const auto prepared = test::prepare(recordings, test::scene_request("silicone_block"));
  double offsets_m[2] = {NAN, NAN};
  for (const RecordingOffset& offset : prepared.common.provenance.offsets) {
    for (std::size_t i = 0; i < 2; ++i)
      if (offset.content_hash == content_hash(*recordings[i])) offsets_m[i] = offset.offset_m;
  }
  EXPECT_NEAR(offsets_m[0] - offsets_m[1], 0.5e-3, 0.05e-3);
}

// The forces of a model of recordings with a common offset are those of a model of the same recordings without it, at
// positions that are moved by the offset.
TEST(PrepareTraining, AModelTouchesWhereItsRecordingsDo) {
  const auto within_jnd = [](double offset_m) {
    const RecordingPtr next = rig("silicone", 2, offset_m);
    const auto model =
        test::fit(test::prepare({rig("silicone", 1, offset_m)}, test::scene_request("silicone_block")), &kRandomMethod);
    EXPECT_NEAR(surface_position_m(model->data().features), offset_m, 0.1e-3);
    ModelErrors errors(model->data().jnd);
    replay(*next, {model}, [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
      if (row.position_m > offset_m) errors.add(snapshot.force_N[0], row.force_N, false);
    });
    return errors.summary().within_jnd;
  };
  // An error of 0.05 mm in the offset changes the share only slightly.
  const double in_place = within_jnd(0.0);
  EXPECT_GT(in_place, 0.9);
  for (const double shift_m : {-12e-3, 0.6e-3, 12e-3}) EXPECT_NEAR(within_jnd(shift_m), in_place, 0.01) << shift_m;
}

}  // namespace
}  // namespace palpate
