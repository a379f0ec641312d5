#include "scenes/scene/jnd_file.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

std::string complaint(const std::string& text) {
  const auto line = parse_jnd_file(text, "jnd.json");
  return line.ok() ? "accepted" : line.error().message;
}

TEST(JndFile, RefusesWithPlaceFoundAndExpected) {
  const std::string advice = "; write it again with palpate study analyse";
  const std::string start = "{\"format\": \"palpate-jnd\",\n\"version\": 1,\n";
  EXPECT_EQ(complaint(start + "\"offset_N\": 0.1, \"weber_fraction\": 0}"), "accepted");
  EXPECT_EQ(complaint("[]"), "jnd.json:1:1: found no \"format\": \"palpate-jnd\", expected a JND file" + advice);
  EXPECT_EQ(complaint("{\"format\": 3}"),
            "jnd.json:1:1: found no \"format\": \"palpate-jnd\", expected a JND file" + advice);
  EXPECT_EQ(complaint("{\"format\": \"palpate-jnd\",\n\"version\": 2}"),
            "jnd.json:2:12: version: found 2, expected version 1" + advice);
  EXPECT_EQ(complaint(start + "\"weber_fraction\": 0}"),
            "jnd.json:1:1: offset_N: found no such field, expected a number above 0 up to 100" + advice);
  EXPECT_EQ(complaint(start + "\"offset_N\": 0, \"weber_fraction\": 0}"),
            "jnd.json:3:13: offset_N: found 0, expected a number above 0 up to 100" + advice);
  EXPECT_EQ(complaint(start + "\"offset_N\": 0.1, \"weber_fraction\": \"6 %\"}"),
            "jnd.json:3:36: weber_fraction: found \"6 %\", expected a number from 0 up to 1" + advice);
  const std::string broken = complaint(start);
  EXPECT_EQ(broken.substr(0, 14), "jnd.json:3:1: ") << broken;
  const std::string none = read_jnd_file("/none/jnd.json").error().message;
  EXPECT_NE(none.find("/none/jnd.json: found no such file"), std::string::npos) << none;
}

}  // namespace
}  // namespace palpate
