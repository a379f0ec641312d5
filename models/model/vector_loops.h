// The vectorised loops of the tick and of the fits, one variant per instruction set (AVX-512, AVX2, SSE4, NEON or
// plain), selected at run time; pure and wait-free. Points are structures of arrays: coordinate k of point i is
// coordinates[k * stride + i]. Loads are fast because CMakeLists.txt lets Eigen align to 64 bytes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "models/model/kernels.h"

namespace palpate::simd {

// The smallest multiple of `lanes` that is not below `count`.
constexpr std::size_t whole_vectors(std::size_t count, std::size_t lanes) noexcept {
  return (count + lanes - 1) / lanes * lanes;
}

// ---- radial basis functions (correction.h), in double precision ----

// The number of doubles in the widest vector; the number in every narrower one divides it.
inline constexpr std::size_t kSimdPad = 8;

// Numbers below this count as 0, so that the product of two others is not denormal.
inline constexpr double kTiny = 1e-100;
inline double without_denormals(double value) noexcept { return value < kTiny && value > -kTiny ? 0.0 : value; }

struct Points {
  const double* coordinates = nullptr;
  std::size_t stride = 0;
  std::size_t padded = 0;  // a multiple of kSimdPad, reached with points of weight 0
  int dimension = 0;
};

// ---- the nearest of a set of points (domain_guard.h), in single precision ----

// Floats in the widest vector used.
inline constexpr std::size_t kSimdPadFloat = 16;

// Values below 1e-11 count as 0. Two such floats that differ then differ by 1e-18 or more, so that their squared
// distance is not denormal.
inline constexpr float kSmallestFloat = 1e-11F;
inline float nearest_float(double value) noexcept {
  return value < kSmallestFloat && value > -kSmallestFloat ? 0.0F : static_cast<float>(value);
}
// Whether the square of a value fits a float; false for NaN.
inline bool in_nearest_range(double value) noexcept { return value < 1e19 && value > -1e19; }

// A binary tree. At split i a query with x[coordinate[i]] < at[i] continues at split 2 i + 1, else at 2 i + 2; the
// splits of the last level lead to the leaves, which are numbered from left to right.
inline constexpr std::size_t kSplitLevels = 5;
inline constexpr std::size_t kLeaves = std::size_t{1} << kSplitLevels;
struct Splits {
  std::array<std::int32_t, kLeaves> coordinate{};  // the last element is unused
  std::array<float, kLeaves> at{};
};

// ---- the loops ----

// Compiled for one dimension and, the first two, for one kernel.
struct Loops {
  // sum_j weights[j] phi(|x - point_j|) + sum_k tail[k] g_k(x), with the tail of the kernel's degree (kernels.h).
  // Coordinates of x below kTiny count as 0.
  double (*evaluate)(const Points& points, const double* weights, const double* tail, const double* x) noexcept;
  // out[i] = phi(|point_i - centre|) for i < count.
  void (*column)(const Points& points, std::size_t count, const double* centre, double* out) noexcept;
  // min_i |x - point_i|^2 of `count` points, a multiple of kSimdPadFloat and their stride.
  float (*nearest)(const float* coordinates, std::size_t count, const float* x) noexcept;
  // Whether one of these points is within the distance whose square is `squared`; false when x is not finite.
  bool (*within)(const float* coordinates, std::size_t count, const float* x, float squared) noexcept;
  // The number of the leaf of x. `rounded`: receives the nearest_float of each coordinate; has room for 8.
  std::size_t (*leaf)(const Splits& splits, const double* x, float* rounded) noexcept;
};
// On the selected instruction set. `dimension`: 1 to 8.
Loops loops(int dimension, KernelKind kernel = KernelKind::cubic);

// The name of the instruction set in use.
std::string target_name();
// For tests, while no other thread builds evaluators: the instruction sets of this processor, best first; uses one of
// them, or the best for 0, for objects built afterwards.
std::vector<std::int64_t> all_targets();
void use_target(std::int64_t target);

}  // namespace palpate::simd
