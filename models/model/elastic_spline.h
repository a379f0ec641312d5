// The elastic response of the trend: a cubic spline on equal pieces of the recorded depth,
//   E(u) = sum_j c_ij t^j,  i = floor(n u),  t = n u - i,  n = kElasticPieces,
// with u = depth / reference depth >= 0. Beyond u = 1 it continues along its tangent there.
// An evaluation takes one look-up and one polynomial, independent of the number of pieces.
//
// `spline_basis` gives the integrals from 0 to u of the quadratic B-splines on these pieces (knots at the ends
// repeated), so that E increases if all weights are non-negative. With a penalty on the differences of neighbouring
// weights E is a P-spline (Eilers & Marx 1996).
// Thread guarantee: value types, pure functions; `at` is wait-free.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace palpate {

// Enough for a force that grows thirty-fold over the last tenth of the depth; the penalty determines the smoothness.
inline constexpr std::size_t kElasticPieces = 32;
inline constexpr std::size_t kElasticCoefficients = 4;  // of a piece

struct ElasticSpline {
  // The coefficients of t^0 to t^3 of every piece, N.
  std::array<double, kElasticPieces * kElasticCoefficients> pieces_N{};

  double at(double u) const noexcept;
  bool operator==(const ElasticSpline&) const = default;
};

inline constexpr std::size_t kElasticTerms = kElasticPieces + 2;
// The kElasticTerms basis splines; weights are in newtons.
std::vector<ElasticSpline> spline_basis();
ElasticSpline combined_spline(const std::vector<ElasticSpline>& basis, const double* weights);

// The spline of an earlier model file, given in truncated powers:
//   sum_k power_N[k] u^(k+1) + sum_k knot_N[k] max(0, u - (k + 1) / 8)^3.
ElasticSpline spline_from_powers(const std::array<double, 3>& power_N, const std::array<double, 7>& knot_N);

}  // namespace palpate
