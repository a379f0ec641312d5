// The radial kernels phi(r) of Hoever & Harders (2009), eq. 2, and their polynomial tails: polyharmonic splines, which
// have no shape parameter to tune. With a tail of at least its degree the kernel times its sign is positive definite on
// every weight vector orthogonal to the tail (Micchelli 1986). The basis of a tail in d variables is 1 for degree 0,
// and 1, x_1 ... x_d for degree 1. Thread guarantee: pure functions, any thread; tail_value is wait-free.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

enum class KernelKind { cubic, linear, thin_plate };  // r^3, r, r^2 log r

inline constexpr std::array<KernelKind, 3> kKernelKinds = {KernelKind::cubic, KernelKind::linear,
                                                           KernelKind::thin_plate};

struct KernelFacts {
  const char* name;
  int tail_degree;           // degree of its polynomial tail
  double definiteness_sign;  // +1 or -1: sign * phi is conditionally positive definite
  // C expression of the kernel for exported code; `squared`: the squared distance.
  const char* c_text;
};

// One row for each kind, in the order of KernelKind. A new kernel is a kind, a row here, its vector form in
// vector_loops.cpp, and its name in assets/formats/model.schema.json.
inline constexpr std::array<KernelFacts, kKernelKinds.size()> kKernels = {{
    {"cubic", 1, 1.0, "squared * SQRT(squared)"},
    {"linear", 0, -1.0, "SQRT(squared)"},
    {"thin-plate", 1, 1.0, "R(0.5) * squared * LOG(squared)"},
}};

constexpr const KernelFacts& kernel_facts(KernelKind kind) noexcept { return kKernels[static_cast<std::size_t>(kind)]; }
constexpr int tail_degree(KernelKind kind) noexcept { return kernel_facts(kind).tail_degree; }
constexpr double definiteness_sign(KernelKind kind) noexcept { return kernel_facts(kind).definiteness_sign; }
constexpr std::string_view kernel_name(KernelKind kind) noexcept { return kernel_facts(kind).name; }

// The kernel of that name; none for an unknown name.
constexpr std::optional<KernelKind> kernel_from_name(std::string_view name) noexcept {
  for (const KernelKind kind : kKernelKinds)
    if (kernel_name(kind) == name) return kind;
  return std::nullopt;
}

inline std::vector<std::string> kernel_names() {
  std::vector<std::string> names;
  for (const KernelFacts& kernel : kKernels) names.emplace_back(kernel.name);
  return names;
}

// Number of monomials, L: 1 or 1 + d.
constexpr int tail_size(int degree, int dimension) noexcept { return degree <= 0 ? 1 : 1 + dimension; }

// The tail at a point. `coefficients`: tail_size values, `x`: d values.
inline double tail_value(const double* coefficients, int degree, int dimension, const double* x) noexcept {
  double sum = coefficients[0];
  for (int k = 0; degree > 0 && k < dimension; ++k) sum += coefficients[1 + k] * x[k];
  return sum;
}

// The matrix G of eq. 6: N x L, one row per point. `points`: d x N.
inline Eigen::MatrixXd tail_matrix(int degree, const Eigen::MatrixXd& points) {
  Eigen::MatrixXd matrix(points.cols(), tail_size(degree, static_cast<int>(points.rows())));
  matrix.col(0).setOnes();
  if (degree > 0) matrix.rightCols(points.rows()) = points.transpose();
  return matrix;
}

}  // namespace palpate
