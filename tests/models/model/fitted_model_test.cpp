#include "models/model/fitted_model.h"

#include <gtest/gtest.h>

#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string message_after(void (*spoil)(ModelData&)) {
  ModelData data = test::example_model("greedy", KernelKind::cubic, test::maxwell_features(), 1);
  EXPECT_TRUE(check_forces(data).ok());
  spoil(data);
  const Status status = check_forces(data);
  return status ? "valid" : status.error().message;
}

// With such a number, the force would jump between zero and its limit.
TEST(FittedModel, ANumberFarBeyondTheLimitsOfTheFileIsRefused) {
  void (*const spoils[])(ModelData&) = {
      [](ModelData& d) { d.trend.elastic.pieces_N[3] = 1e300; },
      [](ModelData& d) { d.trend.reference_depth_m = kNan; },
      [](ModelData& d) { test::change_rbf(d, [](RbfFunction& f) { f.weights(3) = kNan; }); },
      [](ModelData& d) { d.trend.viscosity_Ns_per_m[0] = -1e300; },
      [](ModelData& d) { d.scale(0) = 1e300; },
      [](ModelData& d) { test::change_rbf(d, [](RbfFunction& f) { f.weights *= 1e12; }); },
      [](ModelData& d) { test::change_rbf(d, [](RbfFunction& f) { f.tail(0) = 1e300; }); },
  };
  for (const auto spoil : spoils) {
    const std::string message = message_after(spoil);
    EXPECT_NE(message.find("largest_force_N"), std::string::npos) << message;
  }
  EXPECT_TRUE(test::has_parts(message_after([](ModelData& d) { d.trend.elastic = test::even_spline(1e5, 1e5); }),
                              {"7.03e+04 N", "domain.points[0]", "306.5 N", "largest_force_N", "correction_limit_N"}));
}

// Compares the force with the equation of the header, term by term.
TEST(FittedModel, IsItsEquation) {
  for (const ModelData& data : test::example_models()) {
    const FittedModel model(data);
    const DomainGuard guard(data.cover);
    const Eigen::MatrixXd points = test::random_points(static_cast<int>(data.features.size()), 200, 9);
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      const Eigen::VectorXd u = 1.3 * points.col(i);
      const Eigen::VectorXd x = data.offset + data.scale.cwiseProduct(u);
      const double trend_N = data.trend.at(x.data(), data.features);
      const double h_N = data.correction ? data.correction->evaluate(u.data()) : 0.0;
      const double correction_N = std::clamp(h_N, -data.correction_limit_N, data.correction_limit_N);
      const double expected_N =
          std::clamp(trend_N + guard.trust(u.data()) * correction_N, 0.0, 1.2 * data.largest_force_N);
      const ForceEstimate estimate = model.evaluate(x.data());
      // u -> x -> u rounds, and the kernel's slope is of order 1.
      ASSERT_NEAR(estimate.force_N, expected_N, 1e-10) << data.name;
      ASSERT_EQ(estimate.out_of_domain, guard.trust(u.data()) < 0.5) << data.name;
    }
  }
}

TEST(FittedModel, NeverPullsNorExceedsItsLargestForce) {
  bool floor = false;  // the limit binds in one model at least
  for (ModelData data : test::example_models()) {
    if (rbf_of(data.correction)) test::change_rbf(data, [](RbfFunction& f) { f.weights *= 1e6; });  // a bad fit
    const FittedModel model(data);
    test::Numbers numbers(8);
    for (int i = 0; i < 20000; ++i) {
      std::array<double, kMaxFeatures> x{};
      const double reach = i % 3 == 0 ? 1.0 : i % 3 == 1 ? 3.0 : 1e3;
      for (std::size_t k = 0; k < data.features.size(); ++k) {
        const auto j = static_cast<Eigen::Index>(k);
        x[k] = data.offset(j) + reach * data.scale(j) * numbers.next();
      }
      const double force_N = model.evaluate(x.data()).force_N;
      ASSERT_GE(force_N, 0.0) << data.name;
      ASSERT_LE(force_N, kForceMargin * data.largest_force_N) << data.name;
      floor = floor || force_N == 0.0;
    }
  }
  EXPECT_TRUE(floor);
}

TEST(FittedModel, NotANumberGivesNoForceAndIsOutside) {
  for (const ModelData& data : test::example_models()) {
    const FittedModel model(data);
    for (std::size_t k = 0; k < data.features.size(); ++k) {
      if (data.features[k].kind == FeatureKind::lowpass_velocity) continue;  // not in the trend; see below
      std::array<double, kMaxFeatures> x{};
      x[k] = kNan;
      EXPECT_EQ(model.evaluate(x.data()).force_N, 0.0) << data.name << ", feature " << k;
      EXPECT_TRUE(model.evaluate(x.data()).out_of_domain);
    }
    std::array<double, kMaxFeatures> all{};
    all.fill(kNan);
    EXPECT_EQ(model.evaluate(all.data()).force_N, 0.0);
    for (const double infinite : {kInfinity, -kInfinity}) {
      all.fill(infinite);
      const double force_N = model.evaluate(all.data()).force_N;
      EXPECT_TRUE(force_N >= 0.0 && force_N <= kForceMargin * data.largest_force_N) << data.name;
    }
  }
}

Trend example_trend() {
  Trend trend;
  trend.reference_depth_m = 5e-3;
  trend.elastic = test::even_spline(1.0, 6.0);
  trend.viscosity_Ns_per_m = {2.0, 1.0, 0.5};
  trend.thinning_Ns_per_m = {3.0, 0.0, 1.0};
  trend.thinning_velocity_m_per_s = 0.02;
  trend.velocity_limit_m_per_s = 0.1;
  return trend;
}

double at(const Trend& trend, double depth_m, double velocity_m_per_s) {
  const double x[] = {depth_m, velocity_m_per_s, 0.3, 0.4};
  return trend.at(x, test::paper_features());
}

TEST(Trend, IsItsClosedFormInsideTheData) {
  const Trend trend = example_trend();
  for (const double u : {0.0, 0.3, 1.0}) {
    for (const double v : {-0.05, 0.0, 0.08}) {
      const double elastic = trend.elastic.at(u);
      const double viscous = (2.0 + u + 0.5 * u * u) * v;
      const double thinning = (3.0 + u * u) * v / (1.0 + std::abs(v) / 0.02);
      EXPECT_NEAR(at(trend, u * 5e-3, v), elastic + viscous + thinning, 1e-14) << u << " " << v;
    }
  }
}

}  // namespace
}  // namespace palpate
