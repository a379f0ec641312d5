#include "engine/json/json_position.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

const std::string kText =
    "{\n"
    "  \"a\": [1, {\"b\": \"x\\\"]\"}, [], 3],\n"
    "  \"c\" : {\"d\": {}, \"e\": null}\n"
    "}\n";

std::string at(std::string_view pointer, std::string_view text = kText) {
  return position_prefix("f", position_of_value(text, pointer));
}

TEST(JsonPosition, FindsValuesByPointer) {
  EXPECT_EQ(at(""), "f:1:1: ");
  EXPECT_EQ(at("/a"), "f:2:8: ");
  EXPECT_EQ(at("/a/0"), "f:2:9: ");
  EXPECT_EQ(at("/a/1/b"), "f:2:18: ");
  EXPECT_EQ(at("/a/2"), "f:2:27: ");
  EXPECT_EQ(at("/a/3"), "f:2:31: ");
  EXPECT_EQ(at("/c"), "f:3:9: ");
  EXPECT_EQ(at("/c/e"), "f:3:24: ");
}

TEST(JsonPosition, StopsAtTheDeepestValueOnTheWay) {
  EXPECT_EQ(at("/c/none"), "f:3:9: ");
  EXPECT_EQ(at("/a/7/b"), "f:2:8: ");
  EXPECT_EQ(at("/a/0/b"), "f:2:9: ");
}

TEST(JsonPosition, SurvivesTextThatIsNotJson) {
  for (const char* text : {"", "{", "{\"a", "{\"a\\", "{\"a\":", "[[[[", "[1,", "}", "{\"b\":[}"}) {
    EXPECT_EQ(at("/a/0", text).rfind("f:1:", 0), 0u) << text;
  }
}

TEST(JsonPosition, CountsLinesAndBytes) {
  const TextPosition end = position_of_offset("ab\nc", 100);
  EXPECT_EQ(end.line, 2u);
  EXPECT_EQ(end.column, 2u);
  EXPECT_EQ(position_of_offset("ab\nc", 3).column, 1u);
}

}  // namespace
}  // namespace palpate
