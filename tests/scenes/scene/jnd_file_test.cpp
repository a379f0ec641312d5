#include "scenes/scene/jnd_file.h"

#include <gtest/gtest.h>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

std::string complaint(const std::string& text) {
  const auto line = parse_jnd_file(text, "jnd.json");
  return line.ok() ? "accepted" : line.error().message;
}

TEST(JndFile, RefusesWithPlaceFoundAndExpected) {
  const std::string advice = "palpate study analyse";
  const std::string start = "{\"format\": \"palpate-jnd\",\n\"version\": 1,\n";
  const std::string good = start + "\"offset_N\": 0.1, \"weber_fraction\": 0}";
  EXPECT_EQ(complaint(good), "accepted");
  EXPECT_TRUE(test::has_parts(complaint("[]"), {"jnd.json:1:1:", "\"format\"", "\"palpate-jnd\"", advice}));
  test::expect_messages(
      good, complaint,
      {{"\"palpate-jnd\"", "3", {"jnd.json:1:1:", "\"format\"", "\"palpate-jnd\"", advice}},
       {": 1,", ": 2,", {"jnd.json:2:12:", "version", "2", "1", advice}},
       {"\"offset_N\": 0.1, ", "", {"jnd.json:1:1:", "offset_N", "0", "100", advice}},
       {"0.1", "0", {"jnd.json:3:13:", "offset_N", "0", "0", "100", advice}},
       {"fraction\": 0", "fraction\": \"6 %\"", {"jnd.json:3:36:", "weber_fraction", "6 %", "0", "1", advice}}});
  const std::string broken = complaint(start);
  EXPECT_EQ(broken.substr(0, 14), "jnd.json:3:1: ") << broken;
  EXPECT_TRUE(test::has_parts(read_jnd_file("/none/jnd.json").error().message, {"/none/jnd.json", advice}));
}

}  // namespace
}  // namespace palpate
