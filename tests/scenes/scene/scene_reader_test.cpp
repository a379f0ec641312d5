#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "scenes/material/material.h"
#include "scenes/scene/scene.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using Json = nlohmann::json;

const char* const kGood = R"({
  "name": "x",
  "title": "X",
  "description": "An x.",
  "material": null,
  "features": [
    {"kind": "depth"},
    {"kind": "lowpass_velocity", "relaxation_time_s": 0.5}
  ],
  "jnd": {"offset_N": 0.1, "weber_fraction": 0},
  "block": {"width_m": 0.1, "length_m": 0.2, "height_m": 0.3, "tool_radius_m": 0.004},
  "colours": {"block": "#56B4E9", "tool": "#000000"},
  "default_models": ["greedy"]
})";

std::string complaint(const std::string& text) {
  const auto scene = parse_scene(text, "x.json");
  return scene.ok() ? "accepted" : scene.error().message;
}

TEST(SceneReader, ReadsEveryField) {
  const auto scene = parse_scene(kGood, "folder/x.json");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->title, "X");
  EXPECT_FALSE(scene->material.has_value());
  ASSERT_EQ(scene->features.size(), 2u);
  EXPECT_EQ(scene->features[1].kind, FeatureKind::lowpass_velocity);
  EXPECT_DOUBLE_EQ(scene->features[1].relaxation_time_s, 0.5);
  EXPECT_DOUBLE_EQ(scene->jnd.offset_N, 0.1);
  EXPECT_DOUBLE_EQ(scene->block.length_m, 0.2);
  EXPECT_DOUBLE_EQ(scene->block.tool_radius_m, 0.004);
  EXPECT_EQ(scene->block_colour.red, 0x56);
  EXPECT_EQ(scene->block_colour.blue, 0xE9);
  EXPECT_EQ(scene->default_models, std::vector<std::string>{"greedy"});
  EXPECT_EQ(scene->strongest_press_N, 5.0) << "may be left out";
}

TEST(SceneReader, TakesAStrongestPress) {
  std::string text = kGood;
  text.insert(text.rfind('}'), ", \"strongest_press_N\": 0.9");
  const auto scene = parse_scene(text, "x.json");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->strongest_press_N, 0.9);
}

TEST(SceneReader, TakesItsJndFromAFile) {
  const test::TemporaryFolder folder;
  folder.with_file("own.json", R"({"format": "palpate-jnd", "version": 1, "offset_N": 0.04, "weber_fraction": 0.12})");
  const std::string line = R"("jnd": {"offset_N": 0.1, "weber_fraction": 0})";
  const auto scene = parse_scene(test::replaced(kGood, line, R"("jnd_file": "own.json")"), folder.file("x.json"));
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->jnd.offset_N, 0.04);
  EXPECT_EQ(scene->jnd.weber_fraction, 0.12);
}

TEST(SceneReader, RefusesWithPlaceFoundAndExpected) {
  test::expect_messages(
      kGood, complaint,
      {{R"("name": "x")", R"("name": "y")", {"x.json:2:11:", "name", "\"y\"", "\"x\""}},
       {R"("title": "X")", R"("title": 3)", {"x.json:3:12:", "title", "3"}},
       {"  \"material\": null,\n", "", {"x.json:1:1:", "material"}},
       {"null", R"("silicon")", {"x.json:5:15:", "material", "\"silicon\"", std::string(materials()[0].name)}},
       {"null,", R"(null, "strongest_press_N": 0,)", {"x.json:5:42:", "strongest_press_N", "0", "20"}},
       {R"("depth")", R"("dept")", {"x.json:7:14:", "features[0].kind", "dept", "depth", "x.json:6:15:", "depth"}},
       {"0.5", "-1", {"x.json:8:55:", "features[1].relaxation_time_s", "-1", "0", "100"}},
       {R"(, "relaxation_time_s": 0.5)", "", {"x.json:8:5:", "features[1].relaxation_time_s", "0", "100"}},
       {R"("depth"})", R"("depth", "relaxation_time_s": 1})", {"x.json:7:44:", "features[0]", "depth"}},
       {R"({"kind": "depth"})", R"({"kind": "depth"}, {"kind": "depth"})", {"x.json:7:24:", "features[1]", "twice"}},
       {"offset_N", "offset_mN", {"x.json:10:10:", "jnd.offset_N", "x.json:10:24:", "jnd.offset_mN", "offset_N"}},
       {R"("weber_fraction": 0)", R"("weber_fraction": 7)", {"x.json:10:46:", "jnd.weber_fraction", "7", "0", "1"}},
       {R"("jnd":)", R"("jnd_file": "none.json", "jnd":)", {"x.json:10:35:", "jnd_file", "x.json:10:15:", "none.json"}},
       {R"("jnd": {"offset_N": 0.1, "weber_fraction": 0})", R"("jnd_file": 3)", {"x.json:10:15:", "jnd_file", "3"}},
       {"  \"jnd\": {\"offset_N\": 0.1, \"weber_fraction\": 0},\n", "", {"x.json:1:1:", "jnd", "offset_N", "jnd_file"}},
       {"#56B4E9", "red", {"x.json:12:24:", "colours.block", "\"red\"", "#56B4E9"}},
       {R"("default_models")",
        R"("finish": "wood", "default_models")",
        {"x.json:13:13:", "finish", "wood", "silicone"}},
       {R"("greedy")", R"("best")", {"x.json:13:22:", "default_models[0]", "best", "trend"}}});
}

TEST(SceneReader, LimitsTheNumberOfFeatures) {
  Json document = Json::parse(kGood);
  for (int i = 2; i < 8; ++i) {
    document["features"].push_back({{"kind", "lowpass_velocity"}, {"relaxation_time_s", i}});
  }
  EXPECT_TRUE(parse_scene(document.dump(), "x.json").ok());
  document["features"].push_back({{"kind", "velocity"}});
  const auto nine = parse_scene(document.dump(), "x.json");
  ASSERT_FALSE(nine.ok());
  EXPECT_TRUE(test::has_parts(nine.error().message, {"9", "1 to 8"}));
  document["features"] = Json::array();
  EXPECT_FALSE(parse_scene(document.dump(), "x.json").ok());
}

// Every field in turn has a wrong type or is missing: it is refused without a crash.
TEST(SceneReader, RefusesEveryFieldOfAWrongTypeOrMissing) {
  const Json good = Json::parse(kGood);
  for (const auto& [key, ignored] : good.items()) {
    for (const Json& wrong : {Json(-5), Json(true), Json::array(), Json::array({1}), Json::object(), Json("")}) {
      Json bad = good;
      bad[key] = wrong;
      EXPECT_FALSE(parse_scene(bad.dump(), "x.json").ok()) << key << " as " << wrong;
    }
    Json without = good;
    without.erase(key);
    EXPECT_FALSE(parse_scene(without.dump(), "x.json").ok()) << "without " << key;
  }
}

}  // namespace
}  // namespace palpate
