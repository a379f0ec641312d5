// The radial kernels phi(r) of Hoever & Harders (2009), eq. 2: polyharmonic
// splines, which have no shape parameter to tune.
//
//   linear      r          polynomial tail of degree 0
//   thin-plate  r^2 log r  1
//   cubic       r^3        1
//   quintic     r^5        2
//
// With a tail of at least that degree the kernel times its sign is positive
// definite on every weight vector orthogonal to the tail (Micchelli 1986).
// Thread guarantee: pure functions, any thread; only the name look-up returns
// strings.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

namespace palpate {

enum class KernelKind { cubic, linear, thin_plate, quintic };

inline constexpr std::array<KernelKind, 4> kKernelKinds = {KernelKind::cubic, KernelKind::linear,
                                                           KernelKind::thin_plate, KernelKind::quintic};

// Degree of the polynomial tail that goes with the kernel.
constexpr int tail_degree(KernelKind kind) noexcept {
  switch (kind) {
    case KernelKind::linear: return 0;
    case KernelKind::thin_plate: return 1;
    case KernelKind::cubic: return 1;
    case KernelKind::quintic: return 2;
  }
  return 1;
}

// +1 or -1: sign * phi is conditionally positive definite.
constexpr double definiteness_sign(KernelKind kind) noexcept {
  return kind == KernelKind::linear || kind == KernelKind::quintic ? -1.0 : 1.0;
}

// phi(r) for one r >= 0, in plain scalar code. The hot loops have their own
// vector form in models/model/rbf/rbf_simd.cpp; this one is the reference.
inline double kernel_value(KernelKind kind, double r) noexcept {
  switch (kind) {
    case KernelKind::linear: return r;
    case KernelKind::thin_plate: return r > 0.0 ? r * r * std::log(r) : 0.0;
    case KernelKind::cubic: return r * r * r;
    case KernelKind::quintic: return r * r * r * r * r;
  }
  return 0.0;
}

constexpr std::string_view kernel_name(KernelKind kind) noexcept {
  switch (kind) {
    case KernelKind::linear: return "linear";
    case KernelKind::thin_plate: return "thin-plate";
    case KernelKind::cubic: return "cubic";
    case KernelKind::quintic: return "quintic";
  }
  return "cubic";
}

// The kernel of that name, or nothing when there is none.
constexpr std::optional<KernelKind> kernel_from_name(std::string_view name) noexcept {
  for (const KernelKind kind : kKernelKinds)
    if (kernel_name(kind) == name) return kind;
  return std::nullopt;
}

}  // namespace palpate
