// The inner loops of everything that computes kernels, one variant per
// instruction set, chosen when the program runs. Only rbf_evaluate.cpp uses
// this header; everyone else uses rbf_evaluate.h.
//
// Arrays are structure-of-arrays: coordinate k of point i is at
// coordinates[k * stride + i]; counts are multiples of kSimdPad, made up with
// harmless points (weight 0). Pointers are 64-byte aligned where padded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "models/model/rbf/kernels.h"

namespace palpate::simd {

// Doubles in the widest vector used; every narrower one divides it.
inline constexpr std::size_t kSimdPad = 8;

// Smaller than this in size counts as 0: no product of such numbers is denormal.
inline constexpr double kTiny = 1e-100;
inline double without_denormals(double value) noexcept { return value < kTiny && value > -kTiny ? 0.0 : value; }

struct Points {
  const double* coordinates = nullptr;
  std::size_t stride = 0;
  std::size_t padded = 0;
  int dimension = 0;
};

// sum_j weights[j] phi(|x - point_j|) + sum_k tail[k] g_k(x), with the tail of
// the kernel's degree (polynomial_tail.h); x as without_denormals() has it.
using EvaluateFunction = double (*)(const Points& points, const double* weights, const double* tail,
                                    const double* x) noexcept;
// out[i] = phi(|point_i - centre|) for i < count.
using ColumnFunction = void (*)(const Points& points, std::size_t count, const double* centre, double* out) noexcept;

struct KernelLoops {
  EvaluateFunction evaluate = nullptr;
  ColumnFunction column = nullptr;
};
// The loops for this kernel and dimension (1 to 8) on the chosen target.
KernelLoops kernel_loops(KernelKind kind, int dimension);

// Names of the instruction sets this processor can run, best first, and the
// one in use. choose_target takes one of them, or "" for the best; it concerns
// objects built afterwards. Returns false when there is no such target. For
// tests and benchmarks, not while other threads build evaluators.
std::vector<std::string> target_names();
std::string target_name();
bool choose_target(const std::string& name);

}  // namespace palpate::simd
