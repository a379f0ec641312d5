#include "engine/base/random_stream.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr int kDraws = 200000;

TEST(RandomStream, SameSeedAndStreamGiveTheSameNumbers) {
  RandomStream a(5, 2), b(5, 2);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next(), b.next());
}

TEST(RandomStream, StreamsAndSeedsDiffer) {
  RandomStream a(5, 2), other_stream(5, 3), other_seed(6, 2);
  const std::uint64_t first = a.next();
  EXPECT_NE(first, other_stream.next());
  EXPECT_NE(first, other_seed.next());
}

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

TEST(RandomStream, UniformStaysInsideAndFillsTheRange) {
  RandomStream random(9, 0);
  double low = 1e9, high = -1e9;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.uniform(-2.0, 3.0);
    low = std::min(low, x);
    high = std::max(high, x);
  }
  EXPECT_GE(low, -2.0);
  EXPECT_LT(high, 3.0);
  EXPECT_LT(low, -1.999);
  EXPECT_GT(high, 2.999);
}

TEST(RandomStream, IndexReachesEveryPlaceAboutEquallyOften) {
  RandomStream random(4, 0);
  int count[6] = {};
  for (int i = 0; i < 60000; ++i) ++count[random.index(6)];
  // The standard deviation of a count of 10,000 is 91. The tolerance is five of these.
  for (const int c : count) EXPECT_NEAR(c, 10000, 460);
}

}  // namespace
}  // namespace palpate
