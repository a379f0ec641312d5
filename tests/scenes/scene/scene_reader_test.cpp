#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "scenes/material/material.h"
#include "scenes/scene/scene.h"
#include "tests/support/replaced.h"
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

// The reader's message about the valid text with `from` replaced by `to`.
std::string complaint_after(const std::string& from, const std::string& to) {
  const auto scene = parse_scene(test::replaced(kGood, from, to), "x.json");
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
  EXPECT_EQ(complaint_after("\"material\": null,", "\"material\": null, \"strongest_press_N\": 0,"),
            "x.json:5:42: strongest_press_N: found 0, expected a number above 0 up to 20");
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

TEST(SceneReader, RefusesAJndFileThatIsNone) {
  EXPECT_EQ(complaint_after("\"jnd\":", "\"jnd_file\": \"none.json\", \"jnd\":"),
            "x.json:10:35: jnd: found a \"jnd\" and a \"jnd_file\", expected one of them\n"
            "x.json:10:15: jnd_file: none.json: found no such file, expected a JND file; check the path, or make one "
            "with palpate study analyse");
  EXPECT_EQ(complaint_after("\"jnd\": {\"offset_N\": 0.1, \"weber_fraction\": 0}", "\"jnd_file\": 3"),
            "x.json:10:15: jnd_file: found 3, expected a text that is not empty");
  EXPECT_EQ(
      complaint_after("  \"jnd\": {\"offset_N\": 0.1, \"weber_fraction\": 0},\n", ""),
      "x.json:1:1: jnd: found no such field, expected an object with offset_N and weber_fraction, or a \"jnd_file\"");
}

TEST(SceneReader, RefusesWithPlaceFoundAndExpected) {
  EXPECT_EQ(complaint_after("\"name\": \"x\"", "\"name\": \"y\""),
            "x.json:2:11: name: found \"y\", expected \"x\", the name of the file");
  EXPECT_EQ(complaint_after("\"title\": \"X\"", "\"title\": 3"),
            "x.json:3:12: title: found 3, expected a text that is not empty");
  EXPECT_EQ(complaint_after("  \"material\": null,\n", ""),
            "x.json:1:1: material: found no such field, expected the name of a virtual material, or null");
  std::string known;
  for (const Material& material : materials()) known.append(known.empty() ? "" : ", ").append(material.name);
  EXPECT_EQ(complaint_after("\"material\": null", "\"material\": \"silicon\""),
            "x.json:5:15: material: found \"silicon\", expected one of " + known);
  EXPECT_EQ(
      complaint_after("\"depth\"", "\"dept\""),
      "x.json:7:14: features[0].kind: found \"dept\", expected one of depth, velocity, lowpass_velocity\n"
      "x.json:6:15: features: found no feature of kind \"depth\", expected one: every force depends on the depth");
  EXPECT_EQ(complaint_after("0.5", "-1"),
            "x.json:8:55: features[1].relaxation_time_s: found -1, expected a number above 0 up to 100");
  EXPECT_EQ(complaint_after(", \"relaxation_time_s\": 0.5", ""),
            "x.json:8:5: features[1].relaxation_time_s: found no such field, expected a number above 0 up to 100");
  EXPECT_EQ(
      complaint_after("{\"kind\": \"depth\"}", "{\"kind\": \"depth\", \"relaxation_time_s\": 1}"),
      "x.json:7:44: features[0].relaxation_time_s: found a relaxation time, expected none for the kind \"depth\"");
  EXPECT_EQ(complaint_after("{\"kind\": \"depth\"},", "{\"kind\": \"depth\"}, {\"kind\": \"depth\"},"),
            "x.json:7:24: features[1]: found the same feature twice, expected each once");
  EXPECT_EQ(complaint_after("\"offset_N\": 0.1", "\"offset_mN\": 100"),
            "x.json:10:10: jnd.offset_N: found no such field, expected a number above 0 up to 100\n"
            "x.json:10:24: jnd.offset_mN: found an unknown field, expected one of offset_N, weber_fraction");
  EXPECT_EQ(complaint_after("\"weber_fraction\": 0", "\"weber_fraction\": 7"),
            "x.json:10:46: jnd.weber_fraction: found 7, expected a number from 0 up to 1");
  EXPECT_EQ(complaint_after("#56B4E9", "red"),
            "x.json:12:24: colours.block: found \"red\", expected a colour such as \"#56B4E9\"");
  EXPECT_EQ(complaint_after("\"default_models\"", "\"finish\": \"wood\", \"default_models\""),
            "x.json:13:13: finish: found \"wood\", expected one of silicone, foam, gel, rubber, skin, dome");
  EXPECT_EQ(
      complaint_after("\"greedy\"", "\"best\""),
      "x.json:13:22: default_models[0]: found \"best\", expected one of trend, direct, voxel, random, kdtree, greedy");
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
  EXPECT_NE(nine.error().message.find("found a list of 9, expected a list of 1 to 8 features"), std::string::npos);
  document["features"] = Json::array();
  EXPECT_FALSE(parse_scene(document.dump(), "x.json").ok());
}

TEST(SceneReader, RefusesWhatIsNotJson) {
  const auto cut = parse_scene(std::string(kGood).substr(0, 40), "x.json");
  ASSERT_FALSE(cut.ok());
  EXPECT_EQ(cut.error().message.rfind("x.json:4:", 0), 0u) << cut.error().message;
  for (const char* text : {"", "[]", "null", "{\"name\": 1e999}", "\xff\xfe", "{\"name\": \"\xff\"}"}) {
    EXPECT_FALSE(parse_scene(text, "x.json").ok()) << text;
  }
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
