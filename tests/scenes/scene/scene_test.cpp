#include "scenes/scene/scene.h"

#include <gtest/gtest.h>

#include "models/fit/fit.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

using test::TemporaryFolder;

TEST(Scene, EveryShippedSceneReads) {
  const auto names = scene_names();
  ASSERT_TRUE(names.ok());
  EXPECT_EQ(*names, (std::vector<std::string>{"button", "elastic_block", "foam_block", "jnd_study", "silicone_block",
                                              "skin", "stiff_block"}));
  for (const std::string& name : *names) {
    const auto scene = load_scene(name);
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_EQ(scene->name, name);
    // The paper's line, section 4.1.
    EXPECT_DOUBLE_EQ(scene->jnd.offset_N, 0.065);
    EXPECT_DOUBLE_EQ(scene->jnd.weber_fraction, 0.0633);
  }
}

TEST(Scene, SiliconeHasThePapersFeatures) {
  const auto scene = load_scene("silicone_block");
  ASSERT_TRUE(scene.ok());
  EXPECT_EQ(describe_features(*scene), "depth, velocity, relaxation 0.17 s, relaxation 1.27 s");
  EXPECT_EQ(scene->material, "silicone");
  EXPECT_EQ(scene->default_models.size(), 5u);
}

TEST(Scene, UnknownNameListsTheKnownOnes) {
  for (const std::string name : {"rubber", "", "../scenes/skin", "skin.json"}) {
    const auto scene = load_scene(name);
    ASSERT_FALSE(scene.ok());
    EXPECT_TRUE(test::has_parts(scene.error().message,
                                {name, "elastic_block", "foam_block", "jnd_study", "silicone_block", "stiff_block"}));
  }
}

TEST(Scene, MissingFolderIsNamed) {
  const auto names = scene_names("/none");
  ASSERT_FALSE(names.ok());
  EXPECT_TRUE(test::has_parts(names.error().message, {"/none"}));
}

TEST(Scene, LoadsFromAnyFolder) {
  const TemporaryFolder folder;
  folder.with_file("broken.json", "{");
  folder.with_file("note.txt", "no scene");
  EXPECT_EQ(*scene_names(folder.path()), std::vector<std::string>{"broken"});
  EXPECT_FALSE(load_scene("broken", folder.path()).ok());
}

TEST(Scene, GivesAFitItsFeaturesAndJnd) {
  Scene scene = load_scene("silicone_block").value();
  scene.jnd.offset_N = 0.25;
  const TrainingRequest request = training_request(scene);
  EXPECT_EQ(request.scene, "silicone_block");
  EXPECT_EQ(request.features, scene.features);
  EXPECT_EQ(request.jnd.offset_N, 0.25);
}

}  // namespace
}  // namespace palpate
