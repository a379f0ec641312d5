#include "models/fit/fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/correction/algebra.h"
#include "tests/support/exact_samples.h"
#include "tests/support/message_parts.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

constexpr int kPlaces = 300;
constexpr int kRepeats = 4;
constexpr Eigen::Index kRows = kPlaces * kRepeats;

// A force of two normalised coordinates, 2 to 4 N, with details that take some hundred centres.
double true_force_N(const Eigen::VectorXd& u) { return 3.0 + std::sin(9.0 * u(0)) * std::cos(7.0 * u(1)); }

// Samples at random places in depth and velocity, each of which comes back four times: in other folds, almost at the
// same point, with other noise.
struct Repeated {
  Samples samples;
  Eigen::MatrixXd features;
  Normalisation normalisation;
  Sites sites;
  ModelData common;
};

// `force_of`: the force, N, of the place and the number of a sample; may move the place.
template <typename Force>
Repeated repeated_places(const Force& force_of) {
  Repeated made;
  test::Numbers numbers(5);
  const Eigen::MatrixXd places = test::random_points(2, kPlaces, 3);
  const Eigen::Vector2d middle(3e-3, 0.0), size(2e-3, 0.05);
  made.features.resize(2, kRows);
  made.samples = test::exact_samples(static_cast<std::size_t>(kRows), 5e-3, [&](std::size_t i) {
    const auto row = static_cast<Eigen::Index>(i);
    Eigen::Vector2d u = places.col(row % kPlaces);
    const Eigen::Vector2d moved = 1e-9 * Eigen::Vector2d(numbers.next(), numbers.next());
    const double force_N = force_of(u, i) + 0.2 * numbers.next();
    made.features.col(row) = middle + size.cwiseProduct(u + moved);
    return test::ExactRow{1e-3 * static_cast<double>(i), made.features(0, row), made.features(1, row), force_N,
                          static_cast<int>(5 * row / kRows)};
  });
  made.normalisation = normalisation_of(made.features);
  double step_N = 0.0;
  made.sites = thin(made.samples, made.features, made.normalisation, Thinning::none, step_N);
  made.sites.target_N = made.sites.force_N;
  made.sites.row_scale = made.sites.force_N.cwiseInverse();
  made.common.largest_force_N = made.samples.force_N;
  return made;
}
Repeated repeated_places() {
  return repeated_places([](const Eigen::Vector2d& u, std::size_t) { return true_force_N(u); });
}

OpenChoices select(const Repeated& from, int centres, std::optional<KernelKind> kernel = {}) {
  return test::must(select_open_choices(from.samples, from.features, from.normalisation, from.sites, from.common,
                                        centres, kernel, {}));
}

TEST(OpenChoices, TheBestOfAllKernelsIsSelected) {
  const Repeated from = repeated_places();
  const OpenChoices best = select(from, 50);
  double least = HUGE_VAL;
  for (const KernelKind kernel : kKernelKinds) least = std::min(least, select(from, 50, kernel).error_over_jnd);
  EXPECT_EQ(best.error_over_jnd, least);
}

TEST(OpenChoices, CanBeInterruptedBeforeEachSetting) {
  const Repeated from = repeated_places();
  for (int stop = 1; stop <= 6; ++stop) {
    int asked = 0;
    const FitControl control{[&](double) { return ++asked < stop; }};
    EXPECT_EQ(test::message_of(select_open_choices(from.samples, from.features, from.normalisation, from.sites,
                                                   from.common, 20, {}, control)),
              "interrupted");
    EXPECT_EQ(asked, stop);
  }
}

}  // namespace
}  // namespace palpate
