#include "models/model/elastic_spline.h"

#include <algorithm>

namespace palpate {
namespace {

constexpr double kPieces = kElasticPieces;

// The knots of the quadratic B-splines in units of a piece; those at the ends are threefold.
double knot_at(std::size_t i) { return static_cast<double>(std::clamp<std::size_t>(i, 2, kElasticPieces + 2) - 2); }

// N_i of a degree at x, in units of a piece (Cox-de Boor recursion), continuous from the left at the end.
double b_spline(std::size_t i, int degree, double x) {
  const double first = knot_at(i);
  if (degree == 0) {
    const double next = knot_at(i + 1);
    return (x >= first && x < next) || (x >= kPieces && first < next && next >= kPieces) ? 1.0 : 0.0;
  }
  const auto width = static_cast<std::size_t>(degree);
  const double end = knot_at(i + width + 1);
  double value = 0.0;
  if (const double rise = knot_at(i + width) - first; rise > 0.0) {
    value += (x - first) / rise * b_spline(i, degree - 1, x);
  }
  if (const double fall = end - knot_at(i + 1); fall > 0.0) value += (end - x) / fall * b_spline(i + 1, degree - 1, x);
  return value;
}

}  // namespace

double ElasticSpline::at(double u) const noexcept {
  const double x = u * kPieces;
  const std::size_t piece = x < kPieces ? static_cast<std::size_t>(std::max(0.0, x)) : kElasticPieces - 1;
  const double* c = pieces_N.data() + piece * kElasticCoefficients;
  const double beyond = x > kPieces ? x - kPieces : 0.0;
  const double t = x - static_cast<double>(piece) - beyond;
  const double value = c[0] + t * (c[1] + t * (c[2] + t * c[3]));
  return value + beyond * (c[1] + t * (2.0 * c[2] + t * 3.0 * c[3]));
}

std::vector<ElasticSpline> spline_basis() {
  std::vector<ElasticSpline> basis(kElasticTerms);
  for (std::size_t i = 0; i < kElasticTerms; ++i) {
    double sum = 0.0;
    for (std::size_t piece = 0; piece < kElasticPieces; ++piece) {
      // The quadratic on this piece from three of its values, and its integral over u.
      const auto begin = static_cast<double>(piece);
      const double at_begin = b_spline(i, 2, begin);
      const double at_middle = b_spline(i, 2, begin + 0.5);
      // Continuous from the left, because the last piece ends at a repeated knot.
      const double square = 2.0 * (b_spline(i, 2, begin + 1.0) - 2.0 * at_middle + at_begin);
      const double slope = 2.0 * (at_middle - at_begin) - 0.5 * square;
      double* c = basis[i].pieces_N.data() + piece * kElasticCoefficients;
      c[0] = sum;
      c[1] = at_begin / kPieces;
      c[2] = slope / (2.0 * kPieces);
      c[3] = square / (3.0 * kPieces);
      sum += c[1] + c[2] + c[3];
    }
  }
  return basis;
}

ElasticSpline combined_spline(const std::vector<ElasticSpline>& basis, const double* weights) {
  ElasticSpline sum;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    for (std::size_t j = 0; j < sum.pieces_N.size(); ++j) sum.pieces_N[j] += weights[i] * basis[i].pieces_N[j];
  }
  return sum;
}

ElasticSpline spline_from_powers(const std::array<double, 3>& power_N, const std::array<double, 7>& knot_N) {
  ElasticSpline spline;
  for (std::size_t piece = 0; piece < kElasticPieces; ++piece) {
    const double u = static_cast<double>(piece) / kPieces;
    double value = u * (power_N[0] + u * (power_N[1] + u * power_N[2]));
    double slope = power_N[0] + u * (2.0 * power_N[1] + u * 3.0 * power_N[2]);
    double half_curvature = power_N[1] + 3.0 * u * power_N[2];
    double cubic = power_N[2];
    for (std::size_t k = 0; k < knot_N.size(); ++k) {
      const double above = u - static_cast<double>(k + 1) / 8.0;
      if (above < 0.0) continue;
      value += knot_N[k] * above * above * above;
      slope += 3.0 * knot_N[k] * above * above;
      half_curvature += 3.0 * knot_N[k] * above;
      cubic += knot_N[k];
    }
    double* c = spline.pieces_N.data() + piece * kElasticCoefficients;
    c[0] = value;
    c[1] = slope / kPieces;
    c[2] = half_curvature / (kPieces * kPieces);
    c[3] = cubic / (kPieces * kPieces * kPieces);
  }
  return spline;
}

}  // namespace palpate
