// The vectorised loops of domain_guard.h, one variant per instruction set as in models/model/rbf/rbf_simd.h, whose
// choose_target applies here, too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate::simd {

// Floats in the widest vector used.
inline constexpr std::size_t kSimdPadFloat = 16;
inline constexpr std::size_t kNearLevels = 5;
inline constexpr std::size_t kNearLeaves = std::size_t{1} << kNearLevels;

// Values below 1e-11 count as 0. Two such floats that differ then differ by 1e-18 or more, so that their squared
// distance is not denormal.
inline constexpr float kSmallestFloat = 1e-11F;
inline float nearest_float(double value) noexcept {
  return value < kSmallestFloat && value > -kSmallestFloat ? 0.0F : static_cast<float>(value);
}
// Whether the square of a value fits a float; false for NaN.
inline bool in_nearest_range(double value) noexcept { return value < 1e19 && value > -1e19; }

// min_i |x - point_i|^2 of `count` points, a multiple of kSimdPadFloat; coordinate k of point i is
// coordinates[k * count + i].
using NearestFunction = float (*)(const float* coordinates, std::size_t count, const float* x) noexcept;
// Points relative to a centre c, in the leaves of a tree. For a query q = x - c,
//   |q - p|^2 <= r^2   if   q p - |p|^2 / 2 > (|q|^2 - r^2) / 2,
// which takes one multiplication and addition a coordinate.
struct NearTree {
  // Split i: a query with q[split_coordinate[i]] < split_at[i] continues at split 2 i + 1, else at 2 i + 2. The last
  // element is unused.
  std::array<std::int32_t, kNearLeaves> split_coordinate{};
  std::array<float, kNearLeaves> split_at{};
  // Leaf j begins at leaves + j * leaf_size * (d + 1): one row for each coordinate, and one of -|p|^2 / 2.
  const float* leaves = nullptr;
  std::size_t leaf_size = 0;  // a multiple of kSimdPadFloat
  std::array<double, 8> centre{};
  // r^2 / 2 and 1/2, decreased and increased by the bound on the rounding errors of the two sides.
  float half_squared = 0.0F;
  float half = 0.5F;
};
// The leaf of x.
using LeafFunction = const float* (*)(const NearTree& tree, const double* x) noexcept;
// Whether a point of that leaf is within r; false for NaN.
using NearFunction = bool (*)(const NearTree& tree, const float* leaf_of_x, const double* x) noexcept;

struct NearestLoops {
  NearestFunction nearest = nullptr;
  LeafFunction leaf = nullptr;
  NearFunction near = nullptr;
};
// For dimensions 1 to 8.
NearestLoops nearest_loops(int dimension);

}  // namespace palpate::simd
