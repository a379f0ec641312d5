#include "tests/bench/scalar_loop.h"

#include <cmath>

namespace palpate::bench {

double scalar_cubic_4d(const double* centres, const double* weights, std::size_t count, const double* tail,
                       const double* x) {
  double sum = tail[0];
  for (std::size_t k = 0; k < 4; ++k) sum += tail[1 + k] * x[k];
  for (std::size_t j = 0; j < count; ++j) {
    double squared = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      const double difference = x[k] - centres[4 * j + k];
      squared += difference * difference;
    }
    sum += weights[j] * squared * std::sqrt(squared);
  }
  return sum;
}

}  // namespace palpate::bench
