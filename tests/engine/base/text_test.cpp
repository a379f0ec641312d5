#include "engine/base/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate {
namespace {

TEST(PositionPrefix, CountsLinesAndBytes) {
  EXPECT_EQ(position_prefix("f", "ab\nc", 1), "f:1:2: ");
  EXPECT_EQ(position_prefix("f", "ab\nc", 3), "f:2:1: ");
  EXPECT_EQ(position_prefix("f", "ab\nc", 100), "f:2:2: ");
}

TEST(Utf8, FollowsRfc3629) {
  for (const std::string good : {"", "a", "\xC2\xB5", "\xE2\x82\xAC", "\xF0\x9F\x98\x80", "\xED\x9F\xBF"}) {
    EXPECT_EQ(utf8_bytes(good), good.size()) << good;
  }
  // Invalid UTF-8: lone, overlong, surrogate, beyond U+10FFFF, truncated.
  for (const char* bad : {"a\x80", "a\xC0\x80", "a\xE0\x80\x80", "a\xED\xA0\x80", "a\xF4\x90\x80\x80",
                          "a\xF5\x80\x80\x80", "a\xE2\x82", "a\xF0\x9F\x98z"}) {
    EXPECT_EQ(utf8_bytes(bad), 1u);
  }
}

TEST(Printable, EscapesWhatATerminalWouldObey) {
  EXPECT_EQ(printable("plain \xC2\xB5"), "plain \xC2\xB5");
  EXPECT_EQ(printable("\x1B[2J\x7F\n"), "\\x1b[2J\\x7f\\x0a");
  EXPECT_EQ(printable("\xC2\x9B\xFF"), "\\xc2\\x9b\\xff");
  EXPECT_EQ(printable("abcdef", 3), "abc...");
  EXPECT_EQ(printable("abc", 3), "abc");
  EXPECT_EQ(printable("a\x1B]0;x\a.csv: found\n  b\n", std::string::npos), "a\\x1b]0;x\\x07.csv: found\n  b\n");
}

TEST(Trimmed, TakesBlanksAndTabsFromBothEnds) {
  EXPECT_EQ(trimmed(" \ta b\t "), "a b");
  EXPECT_EQ(trimmed(" \t"), "");
}

TEST(NearestName, IsWithinAThirdOfTheLetters) {
  const std::vector<std::string> names{"method", "recording", "out", "force"};
  EXPECT_EQ(nearest_name("metod", names), "method");
  EXPECT_EQ(nearest_name("recodring", names), "recording");
  EXPECT_EQ(nearest_name("ouput", names), "out");
  EXPECT_EQ(nearest_name("dance", {"help", "json"}), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("metod", {}), "");
}

TEST(ShellWord, IsReadBackByAShellAsOneWord) {
  EXPECT_EQ(shell_word("a/b-1.csv"), "a/b-1.csv");
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word(""), "''");
}

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
