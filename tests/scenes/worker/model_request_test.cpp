#include "scenes/worker/model_worker.h"

#include <gtest/gtest.h>

#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

std::string names(const std::string& scene, const std::vector<std::string>& models) {
  const auto requests = requested_models(load_scene(scene).value(), models);
  if (!requests) return "error: " + requests.error().message;
  std::string text;
  for (const ModelRequest& request : *requests) text += (text.empty() ? "" : ", ") + request_name(request);
  return text;
}

TEST(ModelRequest, TheFirstLineUpIsTheDefault) {
  EXPECT_EQ(names("silicone_block", {}), "voxel, random-100, kdtree-100, greedy-100, trend+greedy-100");
  EXPECT_EQ(names("silicone_block", {"random", "trend", "greedy-10"}), "random-100, trend, greedy-10");
  EXPECT_EQ(names("skin", {}), "") << "a session that waits for a file";
}

TEST(ModelRequest, FilesNeedNoMaterial) {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("mine.json");
  ASSERT_TRUE(save_model(file, test::example_models().front(), false).ok());
  EXPECT_EQ(names("skin", {file}), "mine");
  EXPECT_EQ(names("silicone_block", {file, "trend"}), "mine, trend");
  EXPECT_TRUE(test::has_parts(names("skin", {file, "greedy"}), {"\"skin\"", "palpate fit --scene skin"}));
  const std::string broken = folder.with_file("broken.json", "{}");
  EXPECT_EQ(names("skin", {broken}).rfind("error: " + broken, 0), 0u);
}

TEST(ModelRequest, RefusesUnknownModels) {
  EXPECT_TRUE(test::has_parts(names("silicone_block", {"gredy"}), {"\"gredy\"", "trend", "greedy"}));
  EXPECT_TRUE(test::has_parts(names("silicone_block", std::vector<std::string>(17, "random")),
                              {"17 models", "at most 16", "; "}));
  for (const char* wrong : {"voxel-10", "greedy-", "greedy-x", "2009-greedy"})
    EXPECT_EQ(names("silicone_block", {wrong}).rfind("error: ", 0), 0u) << wrong;
}

TEST(ModelRequest, EveryLineUpCanBeRequested) {
  for (const LineUp& line_up : line_ups()) {
    EXPECT_EQ(names("silicone_block", line_up.models).find("error"), std::string::npos) << line_up.name;
    EXPECT_EQ(find_line_up(line_up.name), &line_up);
  }
  EXPECT_EQ(find_line_up("nothing"), nullptr);
}

}  // namespace
}  // namespace palpate
