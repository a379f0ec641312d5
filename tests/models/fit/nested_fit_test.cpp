#include "models/fit/nested_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/model/fitted_model.h"
#include "tests/support/fit_centres.h"
#include "tests/support/fitting.h"
#include "tests/support/message_parts.h"
#include "tests/support/plain_rbf.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::smooth_sites;

Sites penalised_sites() {
  Sites sites = smooth_sites(4, 900, 0.02, 3);
  sites.smoothing = 1e-3;
  sites.strength = 0.7;
  return sites;
}

// With forces of about 3 N and a condition number of 1e5, values agree to 1e-11 N.
// The tolerance of 1e-10 N is far below any JND.
constexpr double kRounding_N = 1e-10;

void expect_direct(const NestedWeights& nested, Eigen::Index count, const Result<FittedRbf>& direct,
                   const Sites& sites) {
  const auto fitted = nested.solve(count);
  ASSERT_TRUE(direct.ok());
  EXPECT_EQ(fitted.function.centres, direct->function.centres) << count;
  EXPECT_LE(test::largest_difference(fitted.function, direct->function, sites.points), kRounding_N) << count;
  EXPECT_NEAR(fitted.report.residual_rms, direct->report.residual_rms, 1e-9) << count;
}

TEST(NestedFit, GivesEveryDirectFit) {
  for (const Method* method : {&kRandomMethod, &kKdTreeMethod, &kGreedyMethod}) {
    for (const Sites& sites : {penalised_sites(), smooth_sites(3, 400, 0.02, 5)}) {
      const Eigen::VectorXd jnd_N = Eigen::VectorXd::Constant(sites.count(), 0.05);
      for (const KernelKind kernel : kKernelKinds) {
        SCOPED_TRACE(std::string(method->name) + ", " + std::string(kernel_name(kernel)));
        MethodRequest request{.centres = 40, .candidates = 30, .kernel = kernel, .seed = 2};
        const auto chosen = test::choose(*method, sites, jnd_N, request);
        ASSERT_TRUE(chosen.ok());
        const auto nested = NestedWeights::factorise(sites, kernel, *chosen);
        ASSERT_TRUE(nested.ok());
        for (const int count : {0, 1, 2, 7, 25, 40}) {
          if (kernel != KernelKind::cubic && count != 7) continue;
          request.centres = count;
          expect_direct(*nested, count, test::fit_centres(*method, sites, jnd_N, request), sites);
        }
      }
    }
  }
}

TEST(NestedFit, CountsBeyondTheFitAreItsOwn) {
  const Sites sites = penalised_sites();
  const auto nested =
      NestedWeights::factorise(sites, KernelKind::cubic, CentreSequence::growing(sites.points.leftCols(10)));
  ASSERT_TRUE(nested.ok());
  EXPECT_EQ(nested->solve(11).report.centres_used, 10);
  EXPECT_EQ(nested->solve(-1).report.centres_used, 0);
}

TEST(NestedFit, DegenerateSitesGiveFiniteFunctions) {
  for (const Sites& sites : test::degenerate_sites()) {
    const auto chosen = test::choose(kRandomMethod, sites, {}, {.centres = 20});
    ASSERT_TRUE(chosen.ok());
    const auto nested = NestedWeights::factorise(sites, KernelKind::cubic, *chosen);
    ASSERT_TRUE(nested.ok());
    for (Eigen::Index count = 0; count <= nested->most(); ++count) {
      const FittedRbf fitted = nested->solve(count);
      EXPECT_TRUE(fitted.function.weights.allFinite() && fitted.function.tail.allFinite());
    }
  }
}

// Compares the whole model, including name and predicted error.
TEST(NestedFit, GivesTheModelOfTheDirectFit) {
  RigSettings settings;
  settings.seconds = 8.0;
  const PreparedTraining prepared =
      test::prepare({test::rig_recording(settings)}, test::scene_request("silicone_block"));
  for (const Method* method : {&kRandomMethod, &kKdTreeMethod, &kGreedyMethod}) {
    MethodRequest request;
    request.method = method;
    request.centres = 30;
    const auto nested = NestedFit::make(prepared, request);
    ASSERT_TRUE(nested.ok());
    request.centres = 12;
    const auto direct = fit_method(prepared, request);
    const auto fitted = nested->fit(12);
    ASSERT_TRUE(direct.ok() && fitted.ok());
    EXPECT_EQ(fitted->data.name, direct->data.name);
    EXPECT_EQ(fitted->data.method, direct->data.method);
    const FittedModel one(fitted->data);
    const FittedModel other(direct->data);
    for (const auto& features : prepared.set.evaluation_features) {
      const ForceEstimate a = one.evaluate(features.data());
      const ForceEstimate b = other.evaluate(features.data());
      EXPECT_NEAR(a.force_N, b.force_N, kRounding_N);
      // The bound is proportional to errors that agree to rounding.
      EXPECT_NEAR(a.predicted_error_N, b.predicted_error_N, 1e-6);
    }
  }
}

TEST(NestedFit, RefusesAMethodThatDoesNotGoOnFromFewerCentres) {
  PreparedTraining prepared;
  prepared.sites = penalised_sites();
  MethodRequest request;
  request.method = &kDirectMethod;
  const auto nested = NestedFit::make(prepared, request);
  ASSERT_FALSE(nested.ok());
  EXPECT_TRUE(test::has_parts(nested.error().message, {"\"direct\"", "fewer centres"}));
}

}  // namespace
}  // namespace palpate
