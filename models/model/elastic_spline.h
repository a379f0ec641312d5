// The elastic response of the trend: a cubic spline on equal pieces of the recorded depth,
//   E(u) = sum_j c_ij t^j,  i = floor(n u),  t = n u - i,  n = kElasticPieces,
// with u = depth / reference depth >= 0. Beyond u = 1 it continues along its tangent there.
// An evaluation is one look-up and one polynomial, however many pieces there are.
//
// `spline_basis` gives the integrals from 0 to u of the quadratic B-splines on these pieces
// (knots at the ends repeated), so that E rises where no weight is negative. With a penalty on
// differences of neighbouring weights E is a P-spline (Eilers & Marx 1996).
// Thread guarantee: value types, pure functions; `at` is wait-free.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace palpate {

// Enough for a force that grows thirty-fold over the last tenth of the depth; the penalty, not
// their number, decides how smooth the spline is.
inline constexpr std::size_t kElasticPieces = 32;
inline constexpr std::size_t kElasticCoefficients = 4;  // of a piece

struct ElasticSpline {
  // Of every piece the coefficients of t^0 to t^3, newtons.
  std::array<double, kElasticPieces * kElasticCoefficients> pieces_N{};

  double at(double u) const noexcept;
  bool operator==(const ElasticSpline&) const = default;
};

inline constexpr std::size_t kElasticTerms = kElasticPieces + 2;
// kElasticTerms splines; the weights of a sum of them are newtons.
std::vector<ElasticSpline> spline_basis();
ElasticSpline combined_spline(const std::vector<ElasticSpline>& basis, const double* weights);

// The same curve from the form of earlier model files, a cubic spline in truncated powers:
//   sum_k power_N[k] u^(k+1) + sum_k knot_N[k] max(0, u - (k + 1) / 8)^3.
ElasticSpline spline_from_powers(const std::array<double, 3>& power_N, const std::array<double, 7>& knot_N);

}  // namespace palpate
