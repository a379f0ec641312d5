#include "engine/base/json_message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace palpate {
namespace {

using Json = nlohmann::json;

TEST(JsonMessage, SaysWhatWasFoundInFewCharacters) {
  EXPECT_EQ(found(Json("red")), "found \"red\"");
  EXPECT_EQ(found(Json(std::string(100, 'x'))), "found \"" + std::string(36, 'x') + "...");
}

TEST(JsonMessage, ARangeKnowsItsEnds) {
  const NumberRange closed{0.05, 10.0};
  EXPECT_TRUE(closed.holds(0.05) && closed.holds(10.0));
  EXPECT_FALSE(closed.holds(0.049) || closed.holds(10.1) || closed.holds(std::nan("")));
  EXPECT_EQ(closed.words(), "a number from 0.05 up to 10");
  const NumberRange open{0.0, 1e9, true};
  EXPECT_FALSE(open.holds(0.0));
  EXPECT_EQ(open.words(), "a number above 0 up to 1e+09");
}

TEST(JsonMessage, SaysWhereAndWhyATextIsNoJson) {
  const auto cut = parse_json_document<Json>("{\n  \"a\": ]", "x.json");
  ASSERT_FALSE(cut.ok());
  EXPECT_EQ(cut.error().message.rfind("x.json:2:8: syntax error", 0), 0u) << cut.error().message;
  EXPECT_FALSE(parse_json_document<Json>("{\"a\": 1e999}", "x.json").ok());
  EXPECT_TRUE(parse_json_document<Json>("[1]", "x.json").ok());
}

}  // namespace
}  // namespace palpate
