// Errors of the methods on the virtual rig: trained on seed 1, tested on the
// measured force (with sensor noise) of another seed.
//
// Limits are requirements. Where a comment says "reached", the limit is the
// measured value with a margin for other compilers and later changes.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "models/fit/fit.h"
#include "scenes/evaluation/evaluate.h"
#include "tests/support/fitting.h"

namespace palpate::test {
namespace {

ErrorSummary judged(const PreparedTraining& prepared, const Method* method, const RecordingPtr& recording,
                    std::uint64_t seed = 1) {
  const ModelPtr model = fit(prepared, method, seed);
  const ErrorSummary summary = judge(*recording, model);
  std::cout << figures(model->name(), summary) << "\n";
  return summary;
}

// The errors of each stroke, for paired differences.
UnitErrors strokes_of(const RecordingPtr& recording, const ModelPtr& model) {
  EvaluationRequest request;
  request.move_surface = false;
  return must(evaluate(*recording, {{model, model->data().jnd}}, request)).models.front().as_recorded.unit_errors();
}

TEST(SyntheticAccuracy, SiliconeWithAccelerometer) {
  const PreparedTraining prepared = prepare({train_recording("silicone")}, default_request("silicone_block"));
  const ErrorSummary direct = judged(prepared, &kDirectMethod, test_recording("silicone"));
  const ErrorSummary greedy = judged(prepared, &kGreedyMethod, test_recording("silicone"));
  const ErrorSummary kdtree = judged(prepared, &kKdTreeMethod, test_recording("silicone"));
  const ErrorSummary random = judged(prepared, &kRandomMethod, test_recording("silicone"));
  EXPECT_LE(greedy.rms_error_N, 1.15 * direct.rms_error_N);
  EXPECT_GE(greedy.within_jnd, 0.999);
  EXPECT_LT(greedy.max_error_over_jnd, 1.5);
  EXPECT_GE(kdtree.within_jnd, 0.995);
  EXPECT_GE(random.within_jnd, 0.99);
  EXPECT_LT(worst_bin_over_jnd(greedy), 1.0);
}

TEST(SyntheticAccuracy, SiliconeWithTheEncoderAlone) {
  const PreparedTraining prepared =
      prepare({encoder_only(train_recording("silicone"))}, default_request("silicone_block"));
  const ErrorSummary greedy = judged(prepared, &kGreedyMethod, encoder_only(test_recording("silicone")));
  EXPECT_GE(greedy.within_jnd, 0.999);
  EXPECT_LT(worst_bin_over_jnd(greedy), 1.0);
}

// Springs and dashpots with known relaxation times, 0.17 s and 1.27 s.
TEST(SyntheticAccuracy, MaxwellWithTheTimesThatItHas) {
  const PreparedTraining prepared = prepare({train_recording("maxwell")}, scene_request("silicone_block"));
  const ErrorSummary direct = judged(prepared, &kDirectMethod, test_recording("maxwell"));
  const ErrorSummary greedy = judged(prepared, &kGreedyMethod, test_recording("maxwell"));
  EXPECT_GE(greedy.within_jnd, 0.999);
  // Reached: 8.9 mN, 9.6 mN, against 5 mN of force noise alone.
  EXPECT_LE(direct.rms_error_N, 0.012);
  EXPECT_LE(greedy.rms_error_N, 0.013);
}

// Force laws outside the model's class, fitted with default options.
TEST(SyntheticAccuracy, ForeignPhysicsByDefault) {
  struct Law {
    const char* material;
    double within_jnd;
    double max_error_over_jnd;
  };
  // Reached: 99.98, 100, 99.4 and 73.8 %, worst 1.2, 0.9, 1.4 and 19.2 JND. Nothing models the flow of a sponge; the
  // draw of centres alone moves its share between 74.1 and 77.7 %.
  constexpr Law kLaws[] = {
      {"foam", 0.9990, 2.0}, {"layered", 0.9985, 2.0}, {"friction", 0.98, 2.5}, {"sponge", 0.72, 20.0}};
  for (const Law& law : kLaws) {
    SCOPED_TRACE(law.material);
    const RecordingPtr recording = test_recording(law.material);
    const PreparedTraining prepared = prepare({train_recording(law.material)}, default_request("silicone_block"));
    const UnitErrors trend = strokes_of(recording, fit(prepared, &kTrendMethod));
    const UnitErrors greedy = strokes_of(recording, fit(prepared, &kGreedyMethod));
    std::cout << figures("trend", trend) << "\n" << figures("greedy", greedy) << "\n";
    EXPECT_GE(greedy.within_jnd, law.within_jnd);
    EXPECT_LT(greedy.max_error_over_jnd, law.max_error_over_jnd);
    // A correction is used where it lowers the cross-validated squared error. On the test it may be no significant
    // loss: neither a twentieth of the RMS, nor, over the strokes, of the 99 % error.
    EXPECT_LE(greedy.rms_error_N, 1.05 * trend.rms_error_N);
    EXPECT_LE(p99_difference(greedy, trend).low, 0.0);
  }
}

// The candidates are four relaxation times per decade. With the force, one close to each true time must be selected.
TEST(SyntheticAccuracy, IdentifiedRelaxation) {
  const PreparedTraining prepared = prepare({train_recording("foam")}, on_the_force(default_request("foam_block")));
  const std::vector<double> found_s = relaxation_times_s(prepared.common.features);
  const std::vector<double> times_s{0.08, 0.9};
  ASSERT_EQ(found_s.size(), times_s.size());
  for (std::size_t i = 0; i < times_s.size(); ++i)
    EXPECT_LT(std::abs(std::log10(found_s[i] / times_s[i])), 0.2) << times_s[i] << " s";
  const ErrorSummary greedy = judged(prepared, &kGreedyMethod, test_recording("foam"));
  EXPECT_GE(greedy.within_jnd, 0.985);
  EXPECT_LT(greedy.max_error_over_jnd, 4.0);
}

// The true times of this material are 0.17 and 1.27 s. Those of the lowest error of a trend are longer, and the
// cross-validated error of the selected settings, which is printed, shows that they are worse. On recordings the choice
// of the times by that error is worse, so it stays.
TEST(SyntheticAccuracy, IdentifiedRelaxationOfMaxwell) {
  const PreparedTraining found = prepare({train_recording("maxwell")}, on_the_force(default_request("silicone_block")));
  const PreparedTraining truth = prepare({train_recording("maxwell")}, on_the_force(scene_request("silicone_block")));
  const std::vector<double> found_s = relaxation_times_s(found.common.features);
  ASSERT_EQ(relaxation_times_s(truth.common.features), (std::vector<double>{0.17, 1.27}));
  ASSERT_EQ(found_s.size(), 2U);
  EXPECT_LT(std::abs(std::log10(found_s[0] / 0.17)), 0.4) << found_s[0];
  EXPECT_LT(std::abs(std::log10(found_s[1] / 1.27)), 0.8) << found_s[1];
  const auto error_of = [](const PreparedTraining& prepared) {
    return must(fit_method(prepared, {.base = Base::force, .method = &kGreedyMethod})).choices->error_over_jnd;
  };
  EXPECT_LT(error_of(truth), error_of(found));
  EXPECT_GE(judged(found, &kGreedyMethod, test_recording("maxwell")).within_jnd, 0.98);
}

// As with the true times.
TEST(SyntheticAccuracy, MaxwellByDefault) {
  const PreparedTraining prepared = prepare({train_recording("maxwell")}, default_request("silicone_block"));
  const ErrorSummary greedy = judged(prepared, &kGreedyMethod, test_recording("maxwell"));
  EXPECT_GE(greedy.within_jnd, 0.999);
  EXPECT_LT(greedy.max_error_over_jnd, 4.0);
}

TEST(SyntheticAccuracy, StiffAndElasticBlocksWithTheFeaturesTheyNeed) {
  for (const std::string material : {"stiff", "elastic"}) {
    const PreparedTraining prepared = prepare({train_recording(material)}, default_request(material + "_block"));
    const RecordingPtr recording = test_recording(material);
    for (const Method* method : {&kGreedyMethod, &kKdTreeMethod, &kRandomMethod}) {
      const ErrorSummary summary = judged(prepared, method, recording);
      // Reached: all within, worst 0.61 JND.
      EXPECT_GE(summary.within_jnd, 0.999) << material;
      EXPECT_LT(summary.max_error_over_jnd, 1.2) << material;
    }
  }
}

// Reduction by force steps and rows weighted by 1/f, as in Hoever & Harders (2009).
TEST(SyntheticAccuracy, ThePapersRecipeReproducesThePaper) {
  const FitRequest request = on_the_force(scene_request("silicone_block"));
  const PreparedTraining prepared = prepare({train_recording("maxwell")}, request);
  EXPECT_NEAR(static_cast<double>(prepared.sites.count()), 6850.0, 150.0) << "the paper's N";
  const ErrorSummary greedy = judged(prepared, &kGreedyMethod, test_recording("maxwell"));
  const ErrorSummary kdtree = judged(prepared, &kKdTreeMethod, test_recording("maxwell"));
  EXPECT_LT(worst_bin_over_jnd(greedy, 0.5), 1.0);
  EXPECT_LT(worst_bin_over_jnd(kdtree, 0.5), 1.0);
  double squares = 0.0;
  constexpr int kDraws = 5;
  for (int draw = 1; draw <= kDraws; ++draw) {
    const auto seed = static_cast<std::uint64_t>(draw);
    const double rms_N = judged(prepared, &kRandomMethod, test_recording("maxwell"), seed).rms_error_N;
    squares += rms_N * rms_N / kDraws;
  }
  EXPECT_GT(std::sqrt(squares), 1.2 * greedy.rms_error_N) << "reached: 38 mN against 22 mN";
  // Greedy has a smaller error than direct here (73 against 82 mN): the centres of direct fit the
  // noise of small forces, which 1/f weights most. Twelve seconds, because a direct fit to all takes a minute.
  RigSettings settings = train_settings("maxwell");
  settings.seconds = 12.0;
  const PreparedTraining some = prepare({rig_recording(settings)}, request);
  EXPECT_LE(judged(some, &kGreedyMethod, test_recording("maxwell")).rms_error_N,
            1.3 * judged(some, &kDirectMethod, test_recording("maxwell")).rms_error_N);
}

}  // namespace
}  // namespace palpate::test
