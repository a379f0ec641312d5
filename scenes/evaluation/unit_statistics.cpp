#include "scenes/evaluation/unit_statistics.h"

#include <numeric>

namespace palpate {
namespace {

constexpr double kPi = 3.14159265358979323846;

// P(|T| <= t) of Student's t distribution.
double central_probability(double t, std::size_t degrees) {
  const double angle = std::atan(t / std::sqrt(static_cast<double>(degrees)));
  const double cosine = std::cos(angle);
  const bool odd = degrees % 2 == 1;
  double term = odd ? cosine : 1.0;
  double sum = degrees > 1 ? term : 0.0;
  for (std::size_t k = odd ? 3 : 2; k + 2 <= degrees; k += 2) {
    term *= cosine * cosine * static_cast<double>(k - 1) / static_cast<double>(k);
    sum += term;
  }
  return odd ? 2.0 / kPi * (angle + std::sin(angle) * sum) : std::sin(angle) * sum;
}

}  // namespace

double student_t(double above, std::size_t degrees) {
  double low = 0.0;
  double high = 1e6;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (central_probability(middle, degrees) < 1.0 - 2.0 * above ? low : high) = middle;
  }
  return high;
}

double standard_error(const std::vector<double>& values) {
  return ratio_standard_error(values, std::vector<double>(values.size(), 1.0));
}

double ratio_standard_error(const std::vector<double>& numerators, const std::vector<double>& denominators) {
  const std::size_t n = numerators.size();
  if (n < kLeastUnits) return kUnknown;
  const double whole = std::accumulate(denominators.begin(), denominators.end(), 0.0);
  const double ratio = std::accumulate(numerators.begin(), numerators.end(), 0.0) / whole;
  double squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) squares += std::pow(numerators[i] - ratio * denominators[i], 2);
  const auto count = static_cast<double>(n);
  return std::sqrt(count / (count - 1.0) * squares) / whole;
}

Interval interval_95(double estimate, double error, std::size_t units) {
  if (!std::isfinite(error)) return {kUnknown, kUnknown};
  const double half = student_t(0.025, units - 1) * error;
  return {estimate - half, estimate + half};
}

double bound_95(double estimate, double error, std::size_t units) {
  return std::isfinite(error) ? estimate + student_t(0.05, units - 1) * error : kUnknown;
}

}  // namespace palpate
