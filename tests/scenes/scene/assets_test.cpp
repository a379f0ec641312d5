#include "scenes/scene/assets.h"

#include <gtest/gtest.h>

#include <filesystem>

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
  const auto run = test::run_program({prefix.file("bin/palpate"), "scenes"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, "SCENE  TITLE  MATERIAL  FEATURES\n");
}

}  // namespace
}  // namespace palpate
