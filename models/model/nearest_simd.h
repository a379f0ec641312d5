// The vector loops behind nearest_points.h, one variant per instruction set as in
// models/model/rbf/rbf_simd.h, whose choose_target holds for these too.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate::simd {

// Floats in the widest vector used.
inline constexpr std::size_t kSimdPadFloat = 16;
inline constexpr std::size_t kNearLevels = 5;
inline constexpr std::size_t kNearLeaves = std::size_t{1} << kNearLevels;

// As 0 counts what is smaller than 1e-11: two floats that differ and are both 0 or at
// least this differ by 1e-18 or more, so that their squared distance is not denormal.
inline constexpr float kSmallestFloat = 1e-11F;
inline float nearest_float(double value) noexcept {
  return value < kSmallestFloat && value > -kSmallestFloat ? 0.0F : static_cast<float>(value);
}
// Its square is the last that fits a float; false also for what is no number.
inline bool in_nearest_range(double value) noexcept { return value < 1e19 && value > -1e19; }

// min_i |x - point_i|^2; coordinate k of point i is coordinates[k * stride + i], `count` a
// multiple of kSimdPadFloat.
using NearestFunction = float (*)(const float* coordinates, std::size_t stride, std::size_t count,
                                  const float* x) noexcept;
// Points about a centre c, in the leaves of a tree. Of a query q = x - c,
//   |q - p|^2 <= r^2   if   q p - |p|^2 / 2 > (|q|^2 - r^2) / 2,
// one multiplication and addition a coordinate.
struct NearTree {
  // Split i: q below split_at[i] in coordinate split_coordinate[i] goes to 2 i + 1, else to
  // 2 i + 2; the last is unused.
  std::array<std::int32_t, kNearLeaves> split_coordinate{};
  std::array<float, kNearLeaves> split_at{};
  // Leaf j from leaves + j * leaf_size * (d + 1): a row a coordinate, and one of -|p|^2 / 2.
  const float* leaves = nullptr;
  std::size_t leaf_size = 0;  // a multiple of kSimdPadFloat
  std::array<double, 8> centre{};
  // r^2 / 2 and 1/2, less and more by what rounding may do to the two sides.
  float half_squared = 0.0F;
  float half = 0.5F;
};
// The leaf of x.
using LeafFunction = const float* (*)(const NearTree& tree, const double* x) noexcept;
// Whether a point of that leaf is within r. Not so what is no number.
using NearFunction = bool (*)(const NearTree& tree, const float* leaf_of_x, const double* x) noexcept;

struct NearestLoops {
  NearestFunction nearest = nullptr;
  LeafFunction leaf = nullptr;
  NearFunction near = nullptr;
};
// For dimensions 1 to 8.
NearestLoops nearest_loops(int dimension);

}  // namespace palpate::simd
