// The inner loops of all kernel computations, one variant per instruction set, selected at run time. Only
// rbf_evaluate.h, tests and benchmarks include this header.
//
// Points are structures of arrays: coordinate k of point i is coordinates[k * stride + i]. Counts are multiples of
// kSimdPad, padded with points of weight 0. Loads are fast because CMakeLists.txt lets Eigen align to 64 bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "models/model/rbf/kernels.h"

namespace palpate::simd {

// Doubles in the widest vector used; every narrower one divides it.
inline constexpr std::size_t kSimdPad = 8;

// Numbers below this count as 0: no product of two others is denormal.
inline constexpr double kTiny = 1e-100;
inline double without_denormals(double value) noexcept { return value < kTiny && value > -kTiny ? 0.0 : value; }

struct Points {
  const double* coordinates = nullptr;
  std::size_t stride = 0;
  std::size_t padded = 0;
  int dimension = 0;
};

// sum_j weights[j] phi(|x - point_j|) + sum_k tail[k] g_k(x), with the tail of the kernel's degree (polynomial_tail.h).
// Coordinates of x below kTiny count as 0.
using EvaluateFunction = double (*)(const Points& points, const double* weights, const double* tail,
                                    const double* x) noexcept;
// out[i] = phi(|point_i - centre|) for i < count.
using ColumnFunction = void (*)(const Points& points, std::size_t count, const double* centre, double* out) noexcept;

struct KernelLoops {
  EvaluateFunction evaluate = nullptr;
  ColumnFunction column = nullptr;
};
// The loops for this kernel and dimension (1 to 8) on the selected instruction set.
KernelLoops kernel_loops(KernelKind kind, int dimension);

// The names of the instruction sets of this processor, best first, and the one in use. choose_target selects one of
// them, or the best for "", for objects built afterwards; false for an unknown name. For tests and benchmarks only,
// and not while other threads build evaluators.
std::vector<std::string> target_names();
std::string target_name();
bool choose_target(const std::string& name);

}  // namespace palpate::simd
