#include "engine/tick/normal_tail.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

// The header states them; erfc itself is off by the rounding of its argument, amplified by
// x^2. Beyond 6 the series ends a little early.
double tolerance(double x) { return x <= 6.0 ? 3e-14 : 1e-12; }

NormalTail normal_tail(double x) {
  const std::size_t node = normal_table::nearest(x);
  NormalTail tail = normal_table::nodes[node];
  normal_table::continue_to(x, normal_table::place(node), tail.probability, tail.density);
  return tail;
}

TEST(NormalTail, IsErfcAndExpToItsStatedError) {
  for (double x = 0.0; x <= 9.999; x += 0.000917) {
    const NormalTail tail = normal_tail(x);
    const double probability = 0.5 * std::erfc(x / std::sqrt(2.0));
    const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * M_PI);
    ASSERT_NEAR(tail.probability / probability, 1.0, tolerance(x)) << x;
    ASSERT_NEAR(tail.density / density, 1.0, tolerance(x)) << x;
  }
}

}  // namespace
}  // namespace palpate
