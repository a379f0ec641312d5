#include "rendering/app/settings.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(Settings, ComeBackAsTheyWere) {
  const test::TemporaryFolder folder;
  Settings settings;
  settings.theme = Theme::dark;
  settings.block_count = 2;
  settings.difference = false;
  settings.text_size = 1.25F;
  settings.line_up = "2009";
  settings.recent = {"b.csv", "a.json"};
  settings.camera = {0.5F, -0.25F, 1.5F};
  const std::string path = folder.file("window.json");
  ASSERT_TRUE(write_settings(path, settings).ok());
  ASSERT_TRUE(write_settings(path, settings).ok()) << "again";
  const auto back = read_settings(path);
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(*back, settings);
}

TEST(Settings, AreNoReasonNotToStart) {
  const test::TemporaryFolder folder;
  const auto missing = read_settings(folder.file("none.json"));
  ASSERT_TRUE(missing.ok());
  EXPECT_EQ(*missing, Settings{});
  std::ofstream(folder.file("odd.json")) << R"({"blocks": 3, "theme": 7, "text_size": 99, "camera_distance": "far"})";
  const auto odd = read_settings(folder.file("odd.json"));
  ASSERT_TRUE(odd.ok());
  Settings expected;
  expected.text_size = kLargestText;
  EXPECT_EQ(*odd, expected);
  std::ofstream(folder.file("broken.json")) << "{";
  EXPECT_FALSE(read_settings(folder.file("broken.json")).ok());
}

}  // namespace
}  // namespace palpate
