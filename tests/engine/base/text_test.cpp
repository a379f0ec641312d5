#include "engine/base/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate {
namespace {

TEST(Text, FixedRoundsAsPrintfDoes) {
  for (const double value : {0.0, -0.0, 0.125, 2.5, 1.005, -1234.5678, 1e308, 5e-324}) {
    for (const int decimals : {0, 1, 3, 17}) {
      char expected[400];
      std::snprintf(expected, sizeof expected, "%.*f", decimals, value);
      EXPECT_EQ(fixed(value, decimals), expected);
    }
  }
}

TEST(Text, ThreeDigitsKeepTheirNumberWhateverTheSize) {
  EXPECT_EQ(three_digits(8.8749), "8.87");
  EXPECT_EQ(three_digits(0.012345), "0.0123");
  EXPECT_EQ(three_digits(9.999), "10.0");
  EXPECT_EQ(three_digits(99.96), "100");
  EXPECT_EQ(three_digits(12345.0), "12,300");
  EXPECT_EQ(three_digits(-1234567.0), "-1,230,000");
  EXPECT_EQ(three_digits(0.0), "0");
  EXPECT_EQ(three_digits(4.5e9), "4.50e+09");
  EXPECT_EQ(three_digits(std::numeric_limits<double>::infinity()), "–");
}

TEST(Text, AtMostThreeDecimalsWithoutAnExponent) {
  EXPECT_EQ(at_most_three_decimals(0.4123), "0.412");
  EXPECT_EQ(at_most_three_decimals(2.314), "2.31");
  EXPECT_EQ(at_most_three_decimals(9.997), "10.0");
  EXPECT_EQ(at_most_three_decimals(23.14), "23.1");
  EXPECT_EQ(at_most_three_decimals(-231.4), "-231");
  EXPECT_EQ(at_most_three_decimals(std::nan("")), "–");
}

}  // namespace
}  // namespace palpate
