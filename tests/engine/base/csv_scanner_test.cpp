#include "engine/base/csv_scanner.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

TEST(LineScanner, HasALimitOfTheLengthOfALine) {
  const std::string longest(kMaximumLineBytes, 'a');
  for (const std::string start : {"", "\xEF\xBB\xBF"}) {
    LineScanner good(std::make_unique<std::istringstream>(start + longest + "\r\nb"), "x");
    CsvLine line;
    ASSERT_TRUE(good.next(line));
    EXPECT_EQ(line.text, longest);
    ASSERT_TRUE(good.next(line));
    EXPECT_EQ(line.text, "b");
    LineScanner bad(std::make_unique<std::istringstream>(start + longest + "a\nb"), "x");
    EXPECT_FALSE(bad.next(line));
    EXPECT_TRUE(bad.error().has_value());
  }
}

TEST(LineScanner, ReportsAStreamThatFails) {
  // A folder can be opened as a file, but not be read.
  LineScanner scanner(std::make_unique<std::ifstream>("/"), "x.csv");
  CsvLine line;
  EXPECT_FALSE(scanner.next(line));
  ASSERT_TRUE(scanner.error().has_value());
  EXPECT_TRUE(test::has_parts(scanner.error()->message, {"x.csv: ", "Is a"}));
}

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
}

TEST(Trimmed, TakesBlanksAndTabsFromBothEnds) {
  EXPECT_EQ(trimmed(" \ta b\t "), "a b");
  EXPECT_EQ(trimmed(" \t"), "");
}

}  // namespace
}  // namespace palpate
