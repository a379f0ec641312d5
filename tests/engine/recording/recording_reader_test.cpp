#include "engine/recording/recording_reader.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace palpate {
namespace {

// Whether all of `text` is a number, and its value.
std::pair<bool, double> number(std::string_view text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  return {parse_recording_number(text.data(), end, value) == end, value};
}

// glibc's strtod is exactly rounded and serves as an independent reference.
TEST(ParseRecordingNumber, IsExactlyRounded) {
  for (const char* text : {"0.1", "123456.7890123", "9007199254740993", "1.7976931348623157e308", "4.9e-324",
                           "0.00000000012345678901234567890", "-2.2250738585072011e-308"}) {
    const auto [whole, value] = number(text);
    EXPECT_TRUE(whole) << text;
    EXPECT_EQ(value, std::strtod(text, nullptr)) << text;
  }
}

TEST(ParseRecordingNumber, StopsAtTheCommaBehindBlanks) {
  const std::string text = " +1.5 \t,2";
  double value = 0.0;
  const char* const at = parse_recording_number(text.data(), text.data() + text.size(), value);
  EXPECT_EQ(at, text.data() + 7);
  EXPECT_EQ(value, 1.5);
}

TEST(ParseRecordingNumber, RefusesWhatIsNoFiniteNumber) {
  for (const char* text : {"", " ", "+", "-", "+-1", "++1", "- 1", "nan", "inf", "1e999", "0x10", "1 2"}) {
    EXPECT_FALSE(number(text).first) << text;
  }
}

TEST(FieldColumn, CountsBytesFromOneAndSkipsBlanks) {
  EXPECT_EQ(field_column("a,bb, c,,", 0), 1u);
  EXPECT_EQ(field_column("a,bb, c,,", 1), 3u);
  EXPECT_EQ(field_column("a,bb, c,,", 2), 7u);
  EXPECT_EQ(field_column("a,bb, c,,", 3), 9u);
  EXPECT_EQ(field_column("a,bb, c,,", 4), 10u);
  EXPECT_EQ(field_column("a,  ,b", 1), 3u);
}

}  // namespace
}  // namespace palpate
