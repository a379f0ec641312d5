#include "scenes/scene/scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "models/fit/fit.h"
#include "scenes/material/material.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using Json = nlohmann::json;

TEST(Scene, EveryShippedSceneReads) {
  const auto names = test::must(scene_names());
  EXPECT_EQ(names, (std::vector<std::string>{"button", "elastic_block", "foam_block", "jnd_study", "layered_block",
                                             "silicone_block", "skin", "stiff_block"}));
  for (const std::string& name : names) {
    const auto scene = test::must(load_scene(name));
    EXPECT_EQ(scene.name, name);
    // The paper's line, section 4.1.
    EXPECT_DOUBLE_EQ(scene.jnd.offset_N, 0.065);
    EXPECT_DOUBLE_EQ(scene.jnd.weber_fraction, 0.0633);
  }
}

TEST(Scene, SiliconeHasThePapersFeatures) {
  const auto scene = test::must(load_scene("silicone_block"));
  EXPECT_EQ(describe_features(scene), "depth, velocity, relaxation 0.17 s, relaxation 1.27 s");
  EXPECT_EQ(scene.material, "silicone");
}

TEST(Scene, UnknownNameListsTheKnownOnes) {
  for (const std::string name : {"rubber", "", "../scenes/skin", "skin.json"}) {
    EXPECT_TRUE(test::has_parts(load_scene(name),
                                {name, "elastic_block", "foam_block", "jnd_study", "silicone_block", "stiff_block"}));
  }
}

TEST(Scene, GivesAFitItsFeaturesAndJnd) {
  Scene scene = load_scene("silicone_block").value();
  scene.jnd.offset_N = 0.25;
  const TrainingScene given = training_scene(scene);
  EXPECT_EQ(given.name, "silicone_block");
  EXPECT_EQ(given.features, scene.features);
  EXPECT_EQ(given.jnd.offset_N, 0.25);
}

const char* const kGood = R"({
  "title": "X",
  "description": "An x.",
  "material": null,
  "features": [
    {"kind": "depth"},
    {"kind": "lowpass_velocity", "relaxation_time_s": 0.5}
  ],
  "jnd": {"offset_N": 0.1, "weber_fraction": 0},
  "block": {"width_m": 0.1, "length_m": 0.2, "height_m": 0.3, "tool_radius_m": 0.004},
  "colours": {"block": "#56B4E9"}
})";

std::string complaint(const std::string& text) { return test::message_of(parse_scene(text, "x.json")); }

TEST(SceneReader, ReadsEveryField) {
  const auto scene = test::must(parse_scene(kGood, "folder/x.json"));
  EXPECT_EQ(scene.name, "x");
  EXPECT_EQ(scene.title, "X");
  EXPECT_FALSE(scene.material.has_value());
  ASSERT_EQ(scene.features.size(), 2u);
  EXPECT_EQ(scene.features[1].kind, FeatureKind::lowpass_velocity);
  EXPECT_DOUBLE_EQ(scene.features[1].relaxation_time_s, 0.5);
  EXPECT_DOUBLE_EQ(scene.jnd.offset_N, 0.1);
  EXPECT_DOUBLE_EQ(scene.block.length_m, 0.2);
  EXPECT_DOUBLE_EQ(scene.block.tool_radius_m, 0.004);
  EXPECT_EQ(scene.block_colour, 0x56B4E9u);
  EXPECT_EQ(scene.strongest_press_N, 5.0) << "may be left out";
}

TEST(SceneReader, RefusesWithPlaceFoundAndExpected) {
  test::expect_messages(
      kGood, complaint,
      {{R"("title": "X")", R"("title": 3)", {"x.json:2:12:", "title: found 3"}},
       {"  \"material\": null,\n", "", {"x.json:1:1:", "material"}},
       {"null", R"("silicon")", {"x.json:4:15:", "material", "\"silicon\"", std::string(materials()[0].name)}},
       {"null,", R"(null, "strongest_press_N": 0,)", {"x.json:4:42:", "strongest_press_N: found 0", "20"}},
       {R"("depth")", R"("dept")", {"x.json:6:14:", "features[0].kind", "dept", "depth", "x.json:5:15:", "depth"}},
       {"0.5", "-1", {"x.json:7:55:", "features[1].relaxation_time_s: found -1", "above 0", "100"}},
       {R"(, "relaxation_time_s": 0.5)", "", {"x.json:7:5:", "features[1].relaxation_time_s", "above 0", "100"}},
       {R"("depth"})", R"("depth", "relaxation_time_s": 1})", {"x.json:6:44:", "features[0]", "depth"}},
       {R"({"kind": "depth"})", R"({"kind": "depth"}, {"kind": "depth"})", {"x.json:6:24:", "features[1]", "twice"}},
       {"offset_N", "offset_mN", {"x.json:9:10:", "jnd.offset_N", "x.json:9:24:", "jnd.offset_mN", "offset_N"}},
       {R"("weber_fraction": 0)",
        R"("weber_fraction": 7)",
        {"x.json:9:46:", "jnd.weber_fraction: found 7", "from 0", "1"}},
       {R"("jnd":)", R"("jnd_file": "none.json", "jnd":)", {"x.json:9:35:", "jnd_file", "x.json:9:15:", "none.json"}},
       {R"("jnd": {"offset_N": 0.1, "weber_fraction": 0})", R"("jnd_file": 3)", {"x.json:9:15:", "jnd_file: found 3"}},
       {"  \"jnd\": {\"offset_N\": 0.1, \"weber_fraction\": 0},\n", "", {"x.json:1:1:", "jnd", "offset_N", "jnd_file"}},
       {"#56B4E9", "red", {"x.json:11:24:", "colours.block", "\"red\"", "#56B4E9"}},
       {"\"#56B4E9\"}", R"("#56B4E9"}, "finish": "wood")", {"x.json:11:46:", "finish", "wood", "silicone"}},
       {R"("title")", R"("name": "x", "title")", {"x.json:2:11:", "name: found an unknown field", "title"}},
       {"#56B4E9\"", R"(#56B4E9", "tool": "#000000")", {"x.json:11:43:", "colours.tool", "block"}}});
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

std::string jnd_complaint(const std::string& text) { return test::message_of(parse_jnd_file(text, "jnd.json")); }

TEST(JndFile, RefusesWithPlaceFoundAndExpected) {
  const std::string advice = "palpate study analyse";
  const std::string start = "{\"format\": \"palpate-jnd\",\n\"version\": 1,\n";
  const std::string good = start + "\"offset_N\": 0.1, \"weber_fraction\": 0}";
  EXPECT_EQ(jnd_complaint(good), "accepted");
  EXPECT_TRUE(test::has_parts(jnd_complaint("[]"), {"jnd.json:1:1:", "\"format\"", "\"palpate-jnd\"", advice}));
  test::expect_messages(
      good, jnd_complaint,
      {{"\"palpate-jnd\"", "3", {"jnd.json:1:1:", "\"format\"", "\"palpate-jnd\"", advice}},
       {": 1,", ": 2,", {"jnd.json:2:12:", "version: found 2", "version 1", advice}},
       {"\"offset_N\": 0.1, ", "", {"jnd.json:1:1:", "offset_N", "above 0", "100", advice}},
       {"0.1", "0", {"jnd.json:3:13:", "offset_N: found 0", "above 0", "100", advice}},
       {"fraction\": 0", "fraction\": \"6 %\"", {"jnd.json:3:36:", "weber_fraction", "6 %", "from 0", "1", advice}}});
  const std::string broken = jnd_complaint(start);
  EXPECT_EQ(broken.substr(0, 14), "jnd.json:3:1: ") << broken;
  EXPECT_TRUE(test::has_parts(read_jnd_file("/none/jnd.json"), {"/none/jnd.json", advice}));
}

TEST(Assets, TheEnvironmentDecidesAlone) {
  const auto run = test::run_palpate({"scenes"}, {"PALPATE_ASSETS=/none"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_TRUE(test::has_parts(run.err, {"error: ", "folder", "/none", "PALPATE_ASSETS"}));
}

// An installed program: bin/palpate beside share/palpate/scenes.
TEST(Assets, AnInstalledProgramFindsItsOwn) {
  const test::TemporaryFolder prefix;
  std::filesystem::create_directories(prefix.file("bin"));
  std::filesystem::copy_file(PALPATE_BINARY, prefix.file("bin/palpate"));
  std::filesystem::create_directories(prefix.file("share/palpate/scenes"));
  std::ofstream(prefix.file("share/palpate/scenes/note.txt")) << "no scene";
  const auto run = test::run_program({prefix.file("bin/palpate"), "scenes"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, "SCENE  TITLE  MATERIAL  FEATURES\n");
}

class UserFolders : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"XDG_DATA_HOME", "XDG_CONFIG_HOME", "HOME"}) {
      const char* value = std::getenv(name);
      before_.emplace_back(name, value != nullptr ? value : "");
      unsetenv(name);
    }
  }
  void TearDown() override {
    for (const auto& [name, value] : before_)
      value.empty() ? unsetenv(name.c_str()) : setenv(name.c_str(), value.c_str(), 1);
  }
  test::TemporaryFolder folder_;
  std::vector<std::pair<std::string, std::string>> before_;
};

TEST_F(UserFolders, FollowTheEnvironmentElseTheHome) {
  setenv("HOME", folder_.path().c_str(), 1);
  ASSERT_TRUE(data_folder().ok());
  EXPECT_EQ(*data_folder(), folder_.file(".local/share/palpate"));
  EXPECT_EQ(*config_folder(), folder_.file(".config/palpate"));
  EXPECT_TRUE(std::filesystem::is_directory(*config_folder()));
  setenv("XDG_DATA_HOME", folder_.file("data").c_str(), 1);
  EXPECT_EQ(*data_folder(), folder_.file("data/palpate"));
  setenv("XDG_DATA_HOME", "not/absolute", 1);
  EXPECT_EQ(*data_folder(), folder_.file(".local/share/palpate"));
}

}  // namespace
}  // namespace palpate
