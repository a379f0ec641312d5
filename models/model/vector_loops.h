// The vectorised loops of the tick and of the fits, one variant per instruction set (AVX-512, AVX2, SSE4, NEON or
// plain), selected at run time; pure and wait-free. Points are structures of arrays: coordinate k of point i is
// coordinates[k * stride + i]. Loads are fast because CMakeLists.txt lets Eigen align to 64 bytes.
#pragma once

#include <cmath>
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
inline double without_denormals(double value) noexcept { return std::abs(value) < kTiny ? 0.0 : value; }

struct Points {
  const double* coordinates = nullptr;
  std::size_t stride = 0;
  std::size_t padded = 0;  // a multiple of kSimdPad, reached with points of weight 0
  int dimension = 0;
};

// ---- the nearest of a set of points (fitted_model.h), in single precision ----

// Floats in the widest vector used.
inline constexpr std::size_t kSimdPadFloat = 16;

// Values below 1e-11 count as 0. Two such floats that differ then differ by 1e-18 or more, so that their squared
// distance is not denormal.
inline constexpr float kSmallestFloat = 1e-11F;
inline float nearest_float(double value) noexcept {
  return std::abs(value) < kSmallestFloat ? 0.0F : static_cast<float>(value);
}

// Points in cells of kCellPoints, each with the box of its points.
inline constexpr std::size_t kCellPoints = 32;
struct Cells {
  const float* points = nullptr;  // coordinate k of point i of cell c: points[(c * dimension + k) * kCellPoints + i]
  const float* low = nullptr;     // the boxes; coordinate k of cell c: low[k * padded + c]
  const float* high = nullptr;
  std::size_t padded = 0;  // a multiple of kSimdPadFloat, reached with boxes at an infinite distance
};

// ---- the loops ----

// Compiled for one dimension and, the first two, for one kernel.
struct Loops {
  // sum_j weights[j] phi(|x - point_j|) + sum_k tail[k] g_k(x), with the tail of the kernel's degree (kernels.h).
  // Coordinates of x below kTiny count as 0.
  double (*evaluate)(const Points& points, const double* weights, const double* tail, const double* x) noexcept;
  // out[i] = phi(|point_i - centre|) for i < count.
  void (*column)(const Points& points, std::size_t count, const double* centre, double* out) noexcept;
  // The smallest |x - point|^2, or any one that is at most `enough`, for x finite and below 1e19. Examines `cell`
  // first, then each cell whose box is nearer than the nearest point so far; `cell` receives the cell of the result.
  float (*nearest)(const Cells& cells, const double* x, float enough, std::uint32_t& cell) noexcept;
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
