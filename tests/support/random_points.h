// Small reproducible data for numerical tests.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "models/correction/methods.h"
#include "models/model/correction.h"
#include "models/model/kernels.h"

namespace palpate::test {

// A linear congruential generator (Knuth's MMIX constants): the same numbers
// with every compiler.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed * 2 + 1) {}
  // Uniform in [-1, 1).
  double next() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state_ >> 11) * 0x1p-52 - 1.0;
  }

 private:
  std::uint64_t state_;
};

inline Eigen::MatrixXd random_points(int dimension, int count, std::uint64_t seed) {
  Numbers numbers(seed);
  Eigen::MatrixXd points(dimension, count);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = numbers.next();
  return points;
}

inline RbfFunction random_function(KernelKind kernel, int dimension, int centres, std::uint64_t seed) {
  RbfFunction function;
  function.kernel = kernel;
  function.centres = random_points(dimension, centres, seed);
  function.weights = random_points(1, centres, seed + 1).transpose();
  function.tail = random_points(1, tail_size(tail_degree(kernel), dimension), seed + 2).transpose();
  return function;
}

// Random sites with a smooth force of the coordinates, uniform noise of +-`noise_N`, and the scale 1 / JND.
inline Sites smooth_sites(int dimension, int count, double noise_N, std::uint64_t seed) {
  Sites sites;
  sites.points = random_points(dimension, count, seed);
  sites.target_N.resize(count);
  sites.row_scale.resize(count);
  Numbers noise(seed + 7);
  for (int i = 0; i < count; ++i) {
    const auto x = sites.points.col(i);
    const double force = 1.5 + std::exp(0.8 * x[0]) + 0.3 * std::sin(2.0 * x.sum()) + 0.2 * x.squaredNorm();
    sites.target_N[i] = force + noise_N * noise.next();
    sites.row_scale[i] = 1.0 / (0.065 + 0.0633 * std::abs(force));
  }
  return sites;
}

// Degenerate data that every method must accept: zero force, a constant feature,
// duplicates, all sites at one point, one site.
inline std::vector<Sites> degenerate_sites() {
  std::vector<Sites> all(4, smooth_sites(3, 50, 0.0, 1));
  all[0].target_N.setZero();
  all[1].points.row(2).setConstant(1.0);
  all[2].points.rightCols(40) = all[2].points.leftCols(40).eval();
  all[3].points.colwise() = all[3].points.col(0).eval();
  all.push_back(smooth_sites(4, 1, 0.0, 1));
  return all;
}

}  // namespace palpate::test
