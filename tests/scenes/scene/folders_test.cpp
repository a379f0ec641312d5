#include "scenes/scene/folders.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

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
