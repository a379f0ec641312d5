#include "scenes/worker/slot_plan.h"

#include <gtest/gtest.h>

#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

Scene scene(const std::string& name) { return load_scene(name).value(); }

std::string names(const Result<std::vector<SlotPlan>>& plans) {
  if (!plans) return "error: " + plans.error().message;
  std::string text;
  for (const SlotPlan& plan : *plans) text += (text.empty() ? "" : ", ") + plan_name(plan);
  return text;
}

TEST(SlotPlan, TheScenesDefaultAndAlwaysTheDirectInterpolant) {
  EXPECT_EQ(names(plan_slots(scene("silicone_block"), {}, false)), "greedy, kdtree, random, voxel, direct");
  EXPECT_EQ(names(plan_slots(scene("silicone_block"), {"random"}, false)), "random, direct");
  EXPECT_EQ(names(plan_slots(scene("silicone_block"), {"direct", "random"}, true)), "direct, random, position only");
  EXPECT_EQ(names(plan_slots(scene("silicone_block"), {"random"}, true)), "random, position only, direct");
}

TEST(SlotPlan, FilesNeedNoMaterial) {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("mine.json");
  ASSERT_TRUE(save_model(file, test::example_models().front(), false).ok());
  EXPECT_EQ(names(plan_slots(scene("skin"), {file}, false)), "mine");
  EXPECT_EQ(names(plan_slots(scene("silicone_block"), {file}, false)), "mine, direct");
  const std::string refused =
      "error: the scene \"skin\" has no virtual material to fit models to; pass model files, made by "
      "palpate fit --scene skin";
  EXPECT_EQ(names(plan_slots(scene("skin"), {}, false)), "") << "a session that waits for a file";
  EXPECT_EQ(names(plan_slots(scene("skin"), {file, "greedy"}, false)), refused);
  EXPECT_EQ(names(plan_slots(scene("skin"), {file}, true)), "mine") << "nothing to fit one of position alone to";
  const std::string broken = folder.with_file("broken.json", "{}");
  EXPECT_EQ(names(plan_slots(scene("skin"), {broken}, false)).rfind("error: " + broken, 0), 0u);
}

TEST(SlotPlan, RefusesUnknownModels) {
  EXPECT_TRUE(
      test::has_parts(names(plan_slots(scene("silicone_block"), {"gredy"}, false)), {"\"gredy\"", "trend", "greedy"}));
  EXPECT_TRUE(test::has_parts(names(plan_slots(scene("silicone_block"), std::vector<std::string>(16, "random"), false)),
                              {"17 models", "at most 16", "; "}));
}

TEST(SlotPlan, CentresAndThePapersRecipeCanBeAskedFor) {
  EXPECT_EQ(names(plan_slots(scene("silicone_block"), {"greedy-10", "2009-random-20", "2009-voxel"}, false)),
            "greedy-10, 2009-random-20, 2009-voxel, direct");
  for (const char* wrong : {"voxel-10", "greedy-", "greedy-x", "2009-", "2009-lazy-3"})
    EXPECT_FALSE(plan_slots(scene("silicone_block"), {wrong}, false).ok()) << wrong;
}

TEST(SlotPlan, EveryLineUpCanBePlanned) {
  for (const LineUp& line_up : line_ups()) {
    EXPECT_TRUE(plan_slots(scene("silicone_block"), line_up.models, false).ok()) << line_up.name;
    EXPECT_EQ(find_line_up(line_up.name), &line_up);
  }
  EXPECT_EQ(find_line_up("nothing"), nullptr);
}

}  // namespace
}  // namespace palpate
