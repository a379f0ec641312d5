#include "engine/json/json_fields.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

using Json = nlohmann::json;

const std::string kPath = "x.json";
const JsonAdvice kAdvice = {"; mend it", "; copy it again"};

std::string fault_of(const std::string& text, int nesting = 4) {
  const Result<Json> document = parse_json(text, kPath, nesting, kAdvice);
  return document ? "none" : document.error().message;
}

TEST(JsonFields, SaysWhatWasFoundInFewCharacters) {
  EXPECT_EQ(found(Json("red")), "found \"red\"");
  EXPECT_EQ(found(Json::array({1, 2})), "found a list of 2");
  EXPECT_EQ(found(Json::object()), "found an object");
  EXPECT_LT(found(Json(std::string(1000, 'x'))).size(), 60u);
}

TEST(JsonFields, SaysWhereAndWhyATextIsNoJson) {
  EXPECT_EQ(fault_of("[1]"), "none");
  const std::string cut = fault_of("{\n  \"a\": ]");
  EXPECT_EQ(cut.rfind("x.json:2:8: syntax error", 0), 0u) << cut;
  EXPECT_EQ(cut.substr(cut.size() - 15), "; copy it again");
  EXPECT_TRUE(test::has_parts(fault_of("{\"a\": 1e999}"), {"x.json:1:7:", "1e999", "finite", "; "}));
  EXPECT_TRUE(test::has_parts(fault_of("{\"a\": -1e400}"), {"x.json:1:7:", "-1e400", "finite", "; "}));
  EXPECT_TRUE(test::has_parts(fault_of("{\"a\": \"b\xff\"}"), {"x.json:1:", "\\xff", "; "}));
  EXPECT_TRUE(test::has_parts(fault_of("[[[[[1]]]]]"), {"x.json:1:5:", "more than 4", "; "}));
  for (const char* text : {"", "{", "{\"a", "{\"a\\", "{\"a\":", "[[[[", "[1,", "}", "{\"b\":[}"})
    EXPECT_TRUE(test::has_parts(fault_of(text), {"x.json:1:", "; "})) << text;
}

TEST(JsonFields, RefusesWhatAParserWouldPassOver) {
  const std::string twice = fault_of("{\"a\": {\"b\": 1},\n \"b\": [\"b\", \"b\"],\n \"a\": 2}");
  EXPECT_EQ(twice.rfind("x.json:3:2: ", 0), 0u) << twice;
  EXPECT_NE(twice.find("second time"), std::string::npos) << twice;
  EXPECT_EQ(fault_of("[{\"a\": \"b\"}, {\"a\": \"\\\":\"}]"), "none");
  const std::string nul = fault_of(std::string("{\"a\": 1}\0\0", 10));
  EXPECT_EQ(nul.rfind("x.json:1:9: found a NUL byte", 0), 0u) << nul;
}

TEST(JsonFields, NamesThePlaceOfAValue) {
  const std::string text = "{\n  \"a\": [1, {\"b\": \"x\\\"]\"}, [], 3],\n  \"c\" : {\"d\": {}, \"e\": null}\n}\n";
  // A value that does not exist has the place of the deepest existing one on its path.
  const std::pair<const char*, const char*> places[] = {
      {"", "1:1"},   {"/a", "2:8"},    {"/a/0", "2:9"},    {"/a/1/b", "2:18"}, {"/a/2", "2:27"},  {"/a/3", "2:31"},
      {"/c", "3:9"}, {"/c/e", "3:24"}, {"/c/none", "3:9"}, {"/a/7/b", "2:8"},  {"/a/0/b", "2:9"},
  };
  for (const auto& [pointer, place] : places) {
    JsonFields fields(text, kPath, "");
    fields.complain(pointer, "found this");
    EXPECT_TRUE(test::has_parts(fields.error()->message, {std::string("x.json:") + place + ": "})) << pointer;
  }
}

TEST(JsonFields, CollectsAllErrorsEachOnce) {
  const std::string text = "{\"a\": 1,\n \"b\": \"x\",\n \"c\": {\"d\": 1, \"f\": 2}, \"g\": 3}";
  const Result<Json> document = parse_json(text, kPath, 4, kAdvice);
  ASSERT_TRUE(document.ok());
  JsonFields fields(text, kPath, "; mend it");
  const JsonNode top{&*document, ""};
  EXPECT_EQ(fields.filled_text(top, "a"), "");
  fields.complain("/a", "found the same again");
  fields.complain("/a/1", "found what follows from it");
  EXPECT_EQ(fields.number(top, "b", {2.0, 3.0}), 2.0);
  const JsonNode inner = fields.member(top, "c", "an object");
  EXPECT_EQ(fields.number(inner, "d"), 1.0);
  EXPECT_EQ(fields.boolean(inner, "e"), false);
  EXPECT_FALSE(fields.choice(fields.member(top, "g", "a name"), {"one", "two"}));
  fields.refuse_unknown(top);
  EXPECT_EQ(fields.error_count(), 5u);
  EXPECT_TRUE(test::has_parts(
      fields.error()->message,
      {"x.json:1:7: a: found 1", "empty", "x.json:2:7: b: found \"x\"", "from 2", "3", "x.json:3:7:", "no such field",
       "x.json:3:30: g: found 3", "one, two", "x.json:3:21:", "unknown field", "d, e", "; "}));
}

}  // namespace
}  // namespace palpate
