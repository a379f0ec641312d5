#include "scenes/scene/user_folders.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

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

TEST_F(UserFolders, NameTheMissingVariables) {
  ASSERT_FALSE(data_folder().ok());
  EXPECT_TRUE(test::has_parts(data_folder().error().message, {"XDG_DATA_HOME", "HOME", "folder"}));
}

}  // namespace
}  // namespace palpate
