#include "engine/base/random_stream.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr int kDraws = 200000;

// Standard errors at 200,000 draws: mean 1/sqrt(n) = 0.0022, variance
// sqrt(1.9/n) = 0.0031. The tolerance is four standard errors.
TEST(RandomStream, NormalHasMeanZeroAndVarianceOne) {
  RandomStream random(1, 1);
  double sum = 0.0, squares = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double z = random.normal();
    sum += z;
    squares += z * z;
    beyond_two += std::abs(z) > 2.0;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.009);
  EXPECT_NEAR(squares / kDraws, 1.0, 0.0125);
  // A true normal has 4.55 %, the sum of twelve 4.58 %; standard error 0.05 %.
  EXPECT_NEAR(100.0 * beyond_two / kDraws, 4.6, 0.2);
}

}  // namespace
}  // namespace palpate
