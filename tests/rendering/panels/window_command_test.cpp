#include "rendering/panels/window_command.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(WindowCommand, KeysHaveTheNamesThatAreOnThem) {
  EXPECT_EQ(key_name(GLFW_KEY_H), "H");
  EXPECT_EQ(key_name(GLFW_KEY_SLASH), "/");
  EXPECT_EQ(key_name(GLFW_KEY_PAGE_UP), "Page Up");
}

TEST(WindowCommand, TheHelpNamesAllKeysOfARow) {
  WindowCommand command;
  command.keys = {GLFW_KEY_H, GLFW_KEY_SLASH};
  EXPECT_EQ(shown_keys(command), "H, /");
  command.shown = "1 ... 9";
  EXPECT_EQ(shown_keys(command), "1 ... 9");
  command = {};
  command.keys = {GLFW_KEY_Q};
  command.control = true;
  EXPECT_EQ(shown_keys(command), "Ctrl+Q");
}

TEST(WindowCommand, AButtonSaysWhatItDoesNext) {
  bool on = false;
  WindowCommand command;
  command.label = "Stop";
  command.label_on = "Go on";
  command.on = [&] { return on; };
  EXPECT_EQ(shown_label(command), "Stop");
  on = true;
  EXPECT_EQ(shown_label(command), "Go on");
  command.label_on.clear();
  EXPECT_EQ(shown_label(command), "Stop");
}

}  // namespace
}  // namespace palpate
