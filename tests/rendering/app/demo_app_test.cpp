// Tests of the whole window: picture, files, sizes.
#include "rendering/app/demo_app.h"

#include <imgui_internal.h>
#include <png.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/base/text.h"
#include "engine/recording/recording.h"
#include "scenes/worker/model_worker.h"
#include "tests/support/demo_window.h"

namespace palpate {
namespace {

using DemoAppTest = test::DemoWindowTest;
using Size = std::pair<std::uint32_t, std::uint32_t>;

// Pixels of a PNG file.
struct Picture {
  Size size;
  std::vector<unsigned char> pixels;  // RGB
};
Picture read_picture(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0);
  image.format = PNG_FORMAT_RGB;
  Picture picture{{image.width, image.height}, std::vector<unsigned char>(PNG_IMAGE_SIZE(image))};
  EXPECT_NE(png_image_finish_read(&image, nullptr, picture.pixels.data(), 0, nullptr), 0);
  return picture;
}

TEST_F(DemoAppTest, ShowsAPictureThatIsNotEmpty) {
  open("hand");
  frames(30);
  const std::string path = folder_.file("shot.png");
  ASSERT_TRUE(app_->screenshot(path, false).ok());
  EXPECT_FALSE(app_->screenshot(path, false).ok()) << "nothing is written over";
  const auto [size, pixels] = read_picture(path);
  ASSERT_EQ(size, Size(1280, 720));
  std::set<std::uint32_t> scene;
  std::set<std::uint32_t> panel;
  for (std::size_t i = 0; i < pixels.size(); i += 3) {
    const std::uint32_t colour = (std::uint32_t{pixels[i]} << 16) | (std::uint32_t{pixels[i + 1]} << 8) | pixels[i + 2];
    (i / 3 % size.first < 768 ? scene : panel).insert(colour);
  }
  EXPECT_GT(scene.size(), 2000u) << "shaded blocks";
  EXPECT_GT(panel.size(), 100u) << "text and curves";
}

// Nothing is drawn where nothing could be seen, and a display with an odd scale counts as one without.
TEST_F(DemoAppTest, AVerySmallWindowGoesOn) {
  open("hand");
  GLFWwindow* handle = app_->window().handle();
  glfwSetWindowSizeLimits(handle, GLFW_DONT_CARE, GLFW_DONT_CARE, GLFW_DONT_CARE, GLFW_DONT_CARE);
  for (const auto& [width, height] : {std::pair{1, 1}, {300, 1}, {1280, 8}, {300, 40}, {90, 90}, {1280, 720}}) {
    glfwSetWindowSize(handle, width, height);
    frames(6);
  }
  EXPECT_TRUE(app_->window().is_visible());
}

TEST_F(DemoAppTest, ADroppedModelTakesPart) {
  open("hand");
  save("third.json", 3, 1.2);
  drop(folder_.file("third.json"));
  ASSERT_TRUE(until([&] { return app_->session().models().size() == 3 && app_->session().models().all_settled(); }));
  EXPECT_EQ(app_->session().models().info(2).name, "third");
  press(GLFW_KEY_3);
  EXPECT_EQ(app_->session().models().selected(), 2u);
}

TEST_F(DemoAppTest, ModelsAreTakenOut) {
  open("hand");
  LiveSession& session = app_->session();
  session.models().remove(0);
  EXPECT_EQ(session.models().info(0).state, SlotState::hidden);
  EXPECT_EQ(session.models().selected(), 1u) << "the active model is one that is there";
  frames(10);
  press(GLFW_KEY_1);
  EXPECT_EQ(session.models().selected(), 1u) << "keys count what is listed";
}

// Two recordings: models are fitted to one and tested on the whole other one, independent of the playhead.
TEST_F(DemoAppTest, TrainsOnOneRecordingAndTestsOnTheOther) {
  open("hand");
  const std::string train = save_strokes("train.csv", 4000), test = save_strokes("test.csv", 2000, 500.0);
  drop(train);
  drop(test);
  ASSERT_TRUE(until([&] { return app_->view().dialogs.recording_roles.recordings.size() == 2; }));
  EXPECT_EQ(app_->view().dialogs.recording_roles.tested, test) << "the last one";
  press(GLFW_KEY_ENTER);
  ASSERT_TRUE(until([&] { return app_->session().replay() != nullptr; }));
  EXPECT_EQ(app_->session().scene().recordings, std::vector<std::string>{train});
  EXPECT_FALSE(app_->session().tests_training());
  EXPECT_EQ(app_->session().models().info(app_->session().models().size() - 1).name.substr(0, 4), "firm")
      << "what was opened stays";
  ASSERT_TRUE(until([&] { return app_->shown().models.verdict.chosen.has_value(); }));
  EXPECT_EQ(app_->session().test_name(), "test");
  const std::size_t best = *app_->shown().models.verdict.chosen;
  const std::uint64_t samples = app_->session().figures(best).errors.samples;
  app_->session().replay()->pause(true);
  frames(5);
  EXPECT_EQ(app_->session().figures(best).errors.samples, samples);
  // With another test recording, no model is fitted again.
  const std::size_t models = app_->session().models().size();
  app_->view().dialogs.recording_roles = {{{train, {}}}, train, {}};
  frames(1);
  press(GLFW_KEY_ENTER);
  ASSERT_TRUE(until([&] { return app_->session().replay() != nullptr && app_->session().tests_training(); }));
  EXPECT_EQ(app_->session().models().size(), models);
  ASSERT_TRUE(until([&] { return !app_->session().models().ready_slots().empty(); }));
}

// Without scene files and recording, the program ends with an error message instead of a crash.
TEST_F(DemoAppTest, ASessionThatCannotBeReopenedEndsTheProgram) {
  open("hand");
  setenv("PALPATE_ASSETS", folder_.file("gone").c_str(), 1);
  app_->view().dialogs.recording_roles = {{{folder_.file("none.csv"), {}}}, folder_.file("none.csv"), {}};
  frames(1);
  press(GLFW_KEY_ENTER);
  unsetenv("PALPATE_ASSETS");
  EXPECT_TRUE(app_->closing());
  EXPECT_FALSE(app_->outcome().ok());
}

// The virtual display has 1920x1080 pixels.
TEST_F(DemoAppTest, StartsInsideItsScreen) {
  DemoRequest large = request("skin", "hand");
  large.window.width = 2600;
  large.window.height = 1500;
  start(large);
  frames(3);
  EXPECT_EQ(app_->window().size().width, 1920.0F);
  EXPECT_EQ(app_->window().size().height, 1080.0F);
  int x = -1, y = -1;
  glfwGetWindowPos(app_->window().handle(), &x, &y);
  EXPECT_EQ(x, 0);
  EXPECT_EQ(y, 0);
}

// The default start of the program: the silicone block, the first line-up, a simulated hand.
class DefaultStart : public test::DemoWindowTest {
 protected:
  void open_as_started() {
    DemoRequest wanted = request("silicone_block", "hand");
    wanted.session.models.clear();
    wanted.session.line_up = line_ups().front().name;
    start(wanted);
  }
};

// The headline names a model with a block, and its numbers are those of the table.
TEST_F(DefaultStart, TheHeadlineIsOfAModelOnTheStageAndOfTheTablesNumbers) {
  open_as_started();
  ASSERT_TRUE(until([&] { return app_->shown().models.verdict.chosen.has_value(); }));
  const WindowView& shown = app_->shown();
  const std::size_t chosen = *shown.models.verdict.chosen;
  const ModelView& best = shown.models.slots[chosen];
  EXPECT_EQ(std::count(shown.blocks.begin(), shown.blocks.end(), chosen), 1);
  EXPECT_EQ(shown.models.verdict.headline.rfind("Use " + best.name + ": ", 0), 0u) << shown.models.verdict.headline;
  EXPECT_NE(shown.models.verdict.headline.find(tick_text(best.tick_ns())), std::string::npos);
  const nlohmann::json stats = nlohmann::json::parse(stats_text(app_->session(), shown, app_->view().frames));
  EXPECT_EQ(stats["verdict"], shown.models.verdict.headline);
  EXPECT_GT(stats["start"]["verdict_s"], 0.0);
  // A verdict is that of the test: it stays when the errors of the presses are cleared.
  app_->session().reset_figures();
  EXPECT_EQ(app_->session().verdict().chosen, chosen);
}

// With PALPATE_PICTURES=DIR the test fits all models and saves the pictures in DIR for inspection.
TEST_F(DefaultStart, IsDrawnAtEverySizeInBothThemes) {
  open_as_started();
  const char* folder = std::getenv("PALPATE_PICTURES");
  if (folder != nullptr) {
    const double began_s = app_->session().newest().loop_time_s;
    ASSERT_TRUE(until([&] {
      return app_->session().models().all_settled() && app_->session().newest().loop_time_s > began_s + 12.0;
    }));
  }
  press(GLFW_KEY_J);
  app_->session().controls().scale = {1.5, 4.0};
  for (const auto& [width, height] : {std::pair{1024, 600}, std::pair{1280, 720}, std::pair{1920, 1080}}) {
    if (height == 1080) press(GLFW_KEY_J);
    glfwSetWindowSize(app_->window().handle(), width, height);
    glfwSetCursorPos(app_->window().handle(), 4.0, 0.5 * height);  // away from elements with tooltips
    for (const Theme theme : {Theme::light, Theme::dark}) {
      app_->view().settings.theme = theme;
      frames(folder != nullptr ? 60 : 4);
      const std::string name = "window" + std::to_string(height) + (theme == Theme::dark ? "-dark.png" : ".png");
      const std::string path = (folder != nullptr ? std::string(folder) : folder_.path()) + "/" + name;
      ASSERT_TRUE(app_->screenshot(path, true).ok());
      EXPECT_EQ(read_picture(path).size, Size(width, height));
      for (const char* part : {"over title", "over buttons", "panel"}) {
        const ImGuiWindow* window = ImGui::FindWindowByName(part);
        ASSERT_NE(window, nullptr) << part;
        EXPECT_LE(window->Pos.x + window->Size.x, static_cast<float>(width)) << part;
        EXPECT_LE(window->Pos.y + window->Size.y, static_cast<float>(height)) << part;
        EXPECT_EQ(window->ScrollMax.y, 0.0F) << part << " does not fit into " << width;
      }
    }
  }
}

}  // namespace
}  // namespace palpate
