// The vector loops behind nearest_points.h, one variant per instruction set as in
// models/model/rbf/rbf_simd.h, whose choose_target holds for these too.
#pragma once

#include <cstddef>

namespace palpate::simd {

// Floats in the widest vector used.
inline constexpr std::size_t kSimdPadFloat = 16;
inline constexpr std::size_t kNearLevels = 5;
// Rows of 32 splits, the last unused: whole vectors.
inline constexpr std::size_t kNearLeaves = std::size_t{1} << kNearLevels;

// As 0 counts what is smaller than 1e-11: two floats that differ and are both 0 or at
// least this differ by 1e-18 or more, so that their squared distance is not denormal.
inline float nearest_float(double value) noexcept { return value < 1e-11 && value > -1e-11 ? 0.0F : static_cast<float>(value); }
// Its square is the last that fits a float; false also for what is no number.
inline bool in_nearest_range(double value) noexcept { return value < 1e19 && value > -1e19; }

// min_i |x - point_i|^2; coordinate k of point i is coordinates[k * stride + i], `count` a
// multiple of kSimdPadFloat.
using NearestFunction = float (*)(const float* coordinates, std::size_t stride, std::size_t count,
                                  const float* x) noexcept;
// Whether a point of x's leaf has |x - point|^2 <= squared, of x as nearest_float has it.
// The children of split i are
// 2 i + 1 and 2 i + 2, the upper where x[k] >= splits[k * kNearLeaves + i] for some k.
// Leaf j is the `leaf_size` points from leaves + j * leaf_size * dimension, one row a
// coordinate; `leaf_size` a multiple of kSimdPadFloat.
using NearFunction = bool (*)(const float* splits, const float* leaves, std::size_t leaf_size, const double* x,
                              float squared) noexcept;

// For dimensions 1 to 8.
NearestFunction nearest_function(int dimension);
NearFunction near_function(int dimension);

}  // namespace palpate::simd
