// The exhibit as visitors use it: with a mouse, with keys, by touch, with a force device.
#include "rendering/panels/exhibit.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numeric>

#include "tests/support/demo_window.h"
#include "tests/support/fake_device_bus.h"

namespace palpate {
namespace {

// Resident memory of this process in MB.
double resident_MB() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

class ExhibitTest : public test::DemoWindowTest {
 protected:
  using State = ExhibitGame::State;
  const ExhibitGame& game() const { return app_->exhibit().game(); }
  State state() const { return game().state(); }
  bool shows(const std::string& button) const { return app_->exhibit().buttons().count(button) != 0; }
  bool says(const std::string& words) const {
    const auto& said = app_->exhibit().said();
    return std::any_of(said.begin(), said.end(),
                       [&](const std::string& text) { return text.find(words) != std::string::npos; });
  }

  // The next frame takes the key, and the one after it shows what the key did.
  void press(int key, int modifiers = 0) {
    DemoWindowTest::press(key, modifiers);
    frames(1);
  }

  struct Setting {
    ExhibitTimes times{1.0, 4.0, 2.0, 0.5};
    DeviceBus* bus = nullptr;  // a force device
    bool learned = false;      // fit the models of the exhibit, which takes longer
    int height = 720;
  };
  void open_exhibit(const Setting& setting) {
    const bool felt = setting.bus != nullptr;
    DemoRequest wanted = request(felt ? "skin" : "silicone_block", felt ? "hid" : "auto");
    wanted.window.height = setting.height;
    wanted.window.width = setting.height * 16 / 9;
    if (!felt) wanted.session.models = {"random-3", "kdtree-10", "greedy-20"};  // quick fits
    if (setting.learned) wanted.session.models.clear();
    wanted.session.bus = setting.bus;
    wanted.exhibit = true;
    wanted.exhibit_times = setting.times;
    start(wanted);
    for (int i = 0; i < 5 && !shows("1"); ++i) (void)until([&] { return shows("1"); });
    ASSERT_TRUE(shows("1")) << "has learned";
  }

  // Moves the handle of a force device into the block and out again, at the speed of a hand.
  void stroke_device() {
    for (const int to : {460, 0}) {
      ASSERT_TRUE(until([&] {
        bus_.counts += std::clamp(to - bus_.counts, -20, 20);
        return bus_.counts == to && app_->session().newest().tick.in_contact == (to > 0);
      }));
    }
  }

  test::FakeDeviceBus bus_;  // outlives the window, which a failed test leaves open
  std::string pictures_;

  // The pixel `below_px` below the middle of a block's top.
  ImVec2 block(std::size_t index, float below_px) const {
    const glm::vec2 top = app_->blocks().on_screen(index, 2, {0.0F, 0.0F, 0.0F}, {768.0F, 720.0F});
    return {top.x, top.y + below_px};
  }
  void move(const ImVec2& to, int then = 3) { move_mouse(static_cast<double>(to.x), static_cast<double>(to.y), then); }
  // Moves the mouse to the button and clicks.
  void click_on(const std::string& button) {
    ASSERT_TRUE(until([&] { return shows(button); })) << button;
    move(app_->exhibit().buttons().at(button));
    click();
  }
  // A touch: the pointer appears at `at` and is pressed at the same time.
  void touch(const ImVec2& at, int held_frames = 3) {
    move(at, 0);
    left_button(GLFW_PRESS, held_frames);
    left_button(GLFW_RELEASE, 3);
  }
  void touch_on(const std::string& button) {
    ASSERT_TRUE(until([&] { return shows(button); })) << button;
    touch(app_->exhibit().buttons().at(button));
  }
  void expect_released() {
    EXPECT_TRUE(until([&] {
      const LoopSnapshot& newest = app_->session().newest();
      return newest.rendered_N == 0.0 && !newest.tick.in_contact;
    })) << "nobody presses while reading";
  }

  // Saves a picture of this screen if PALPATE_PICTURES names a folder.
  void picture(const std::string& name) {
    frames(2);
    EXPECT_TRUE(app_->exhibit().fits()) << name;
    const char* folder = std::getenv("PALPATE_PICTURES");
    if (folder == nullptr) return;
    EXPECT_TRUE(app_->screenshot(std::string(folder) + "/" + pictures_ + name + ".png", true).ok());
  }

  // Plays from the invitation to the score. `press_button` presses a button, `stroke` presses both blocks.
  void play(const std::function<void(const char*)>& press_button, const std::function<void()>& stroke) {
    press_button("1");
    for (int round = 1; round <= 3; ++round) {
      ASSERT_EQ(state(), State::press);
      EXPECT_TRUE(says("Round " + std::to_string(round) + " of 3"));
      EXPECT_TRUE(app_->exhibit().is_blind());
      EXPECT_FALSE(shows("1")) << "no question before a press";
      ASSERT_TRUE(until([&] {
        if (!game().can_answer()) stroke();
        return game().can_answer() && shows("1");
      }));
      EXPECT_GT(game().trace().columns().size(), 10u) << "what was pressed was drawn";
      press_button(round == 3 ? "2" : "1");
      ASSERT_EQ(state(), State::reveal);
      EXPECT_FALSE(app_->exhibit().is_blind());
      expect_released();
      press_button("Enter");
    }
    ASSERT_EQ(state(), State::score);
    EXPECT_TRUE(says("Your presses, each computer"));
    press_button("Enter");
    frames(2);
    EXPECT_TRUE(says("millionth"));
    EXPECT_TRUE(says("Fooled by it today"));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_GT(game().largest_over_jnd(i), 0.0);
  }
  void visit_with_mouse() {
    float below_px = 0.0F;
    play([&](const char* button) { click_on(button); },
         [&] { move(block(0, below_px = below_px > 60.0F ? -40.0F : below_px + 25.0F)); });
  }
  void visit_by_touch() {
    play([&](const char* button) { touch_on(button); }, [&] { touch(block(1, 60.0F), 12); });
  }
  void visit_with_keys() {
    const std::map<std::string, int> keys = {{"1", GLFW_KEY_1}, {"2", GLFW_KEY_2}, {"Enter", GLFW_KEY_ENTER}};
    play(
        [&](const char* button) {
          ASSERT_TRUE(until([&] { return shows(button); })) << button;
          press(keys.at(button));
        },
        [&] {
          hold(GLFW_KEY_DOWN, [&] { return app_->session().newest().tick.depth_m > 0.005; });
          hold(GLFW_KEY_UP, [&] { return !app_->session().newest().tick.in_contact; });
        });
  }
};

TEST_F(ExhibitTest, IsPlayedWithAMouseAlone) {
  open_exhibit({});
  EXPECT_TRUE(says("Can you tell the computer from the block?"));
  EXPECT_EQ(app_->view().settings.blocks, 2u) << "the comparison, not an empty block";
  visit_with_mouse();
  click_on("Enter");
  EXPECT_EQ(state(), State::press) << "once more";
  EXPECT_EQ(game().largest_over_jnd(0), 0.0) << "and from the beginning";
}

// A pointer without a button passes from the air over a block into it in one jump.
TEST_F(ExhibitTest, OneStrokeIsOnePress) {
  open_exhibit({{1.0, 300.0, 2.0, 0.5}});
  press(GLFW_KEY_1);
  ASSERT_TRUE(until([&] { return game().lifted(); })) << "the simulated hand is gone";
  move(block(0, -60.0F));
  move(block(0, 120.0F), 30);
  EXPECT_TRUE(app_->session().newest().tick.in_contact);
  double last_m = app_->session().newest().tick.position_m;
  for (const float below_px : {180.0F, 240.0F, 300.0F}) {
    move(block(0, below_px), 40);
    EXPECT_GE(app_->session().newest().tick.position_m, last_m - 1e-4) << below_px;
    last_m = app_->session().newest().tick.position_m;
  }
  move({1100.0F, 300.0F}, 30);
  EXPECT_FALSE(app_->session().newest().tick.in_contact) << "outside of the picture";
}

// The result appears at the end, with both blocks at the moment of the largest difference.
TEST_F(ExhibitTest, TheRevealIsTheVisitorsOwnPressInSlowMotion) {
  open_exhibit({{1.0, 300.0, 2.0, 2.0}});
  press(GLFW_KEY_1);
  hold(GLFW_KEY_DOWN, [&] { return game().can_answer() && shows("1"); });
  const auto poses = [&] { return app_->exhibit().shown_poses(app_->shown(), Theme::dark); };
  ASSERT_EQ(poses().size(), 2u);
  EXPECT_EQ(poses()[0].arrow, poses()[1].arrow) << "nothing gives the answer away";
  EXPECT_FALSE(poses()[0].shows_error || poses()[1].shows_error);
  const double began_s = app_->session().newest().loop_time_s;
  press(GLFW_KEY_1);
  ASSERT_EQ(state(), State::reveal);
  const ExhibitTrace& trace = game().trace();
  ASSERT_TRUE(until([&] { return shows("Enter"); }));
  EXPECT_GT(app_->session().newest().loop_time_s, began_s + 0.5) << "slower";
  EXPECT_LT(app_->session().newest().tick.position_m, 0.0) << "the tool itself is out of the block";
  const std::vector<BlockPose> last = poses();
  const std::size_t computer = game().round().computer_is_left ? 0 : 1;
  EXPECT_NEAR(static_cast<double>(last[computer].error_over_jnd), trace.largest_over_jnd(), 1e-3);
  EXPECT_NEAR(static_cast<double>(last[computer].tool_m), trace.columns()[trace.largest_at()].position_m, 1e-6);
  EXPECT_NE(last[0].arrow, last[1].arrow) << "the truth is shown";
  frames(10);
  EXPECT_EQ(poses()[computer].force_N, last[computer].force_N) << "it stands still";
}

// After a stroke with the best model, the same stroke is shown with the worst one, and then the next stroke.
TEST_F(ExhibitTest, TheInvitationShowsTheSameStrokeWithAWorseModel) {
  open_exhibit({});
  ASSERT_TRUE(until([&] { return says("the best computer"); }));
  ASSERT_TRUE(until([&] { return app_->exhibit().shows_worst(); }));
  frames(1);
  EXPECT_TRUE(says("a worse computer"));
  EXPECT_EQ(app_->exhibit().shown_poses(app_->shown(), Theme::dark).size(), 2u);
  ASSERT_TRUE(until([&] { return !app_->exhibit().shows_worst(); }));
}

// If pictures are saved, the exhibit fits its own models.
TEST_F(ExhibitTest, EveryScreenIsDrawnInBothLanguagesAtBothSizes) {
  const bool learned = std::getenv("PALPATE_PICTURES") != nullptr;
  for (const int height : {720, 1080}) {
    open_exhibit({{learned ? 6.0 : 1.0, 300.0, 285.0, learned ? 4.0 : 0.5}, nullptr, learned, height});
    for (const char* language : {"en", "de"}) {
      pictures_ = language + std::to_string(height) + "-";
      until([&] { return app_->exhibit().attract_trace().seconds() > 0.6 * (learned ? 6.0 : 1.0); });
      picture("attract");
      press(GLFW_KEY_L);
    }
    for (const char* language : {"en", "de"}) {
      pictures_ = language + std::to_string(height) + "-";
      press(GLFW_KEY_ENTER);
      for (const char* round : {"1", "2", "3"}) {
        hold(GLFW_KEY_DOWN, [&] { return game().can_answer() && app_->session().newest().tick.depth_m > 0.005; });
        picture(std::string("press") + round);
        press(GLFW_KEY_1);
        ASSERT_EQ(state(), State::reveal);
        if (learned) frames(60);
        picture(std::string("slow") + round);
        ASSERT_TRUE(until([&] { return shows("Enter"); }));
        picture(std::string("reveal") + round);
        press(GLFW_KEY_ENTER);
      }
      if (learned) until([&] { return says("Ends in") || says("Endet in"); });
      picture("score");
      EXPECT_EQ(state(), State::score);
      press(GLFW_KEY_ENTER);
      picture("farewell");
      press(GLFW_KEY_L);
    }
    app_.reset();
  }
}

// Judged by the same presses, more moments are better, however the visitor presses.
TEST_F(ExhibitTest, TheObviousIsNoticedAndTheBestIsNot) {
  open_exhibit({{4.0, 30.0, 2.0, 0.5}, nullptr, true});
  visit_with_keys();
  EXPECT_GT(game().largest_over_jnd(0), 1.0);
  EXPECT_GT(game().largest_over_jnd(0), game().largest_over_jnd(1));
  EXPECT_GT(game().largest_over_jnd(1), game().largest_over_jnd(2));
}

// PALPATE_VISITORS visitors (2 or more, default 4; 30 take about ten minutes) in turn use the mouse, keys
// and touch. After each one the exhibit must return to its initial state.
TEST_F(ExhibitTest, IsAsNewAfterManyVisitors) {
  const char* asked = std::getenv("PALPATE_VISITORS");
  const int visitors = asked != nullptr ? std::atoi(asked) : 4;
  open_exhibit({});
  frames(60);  // until the camera is at rest
  const ImVec2 home = block(0, 0.0F);
  std::vector<double> resident{resident_MB()};
  for (int i = 0; i < visitors; ++i) {
    if (i % 3 == 0) visit_with_mouse();
    if (i % 3 == 1) visit_with_keys();
    if (i % 3 == 2) visit_by_touch();
    for (const std::uint64_t answers : app_->exhibit().tally().answers)
      EXPECT_EQ(answers, static_cast<std::uint64_t>(i + 1));
    press(GLFW_KEY_L);
    ASSERT_EQ(state(), State::score);
    ASSERT_TRUE(until([&] { return state() == State::attract; })) << "forgotten";
    EXPECT_EQ(app_->session().newest().rendered_N, 0.0);
    frames(3);
    EXPECT_TRUE(says("Can you tell")) << "in the first language";
    EXPECT_TRUE(app_->session().tool_input()->hand_is_exploring()) << "the comparison goes on at once";
    EXPECT_NEAR(block(0, 0.0F).x, home.x, 0.5F);
    resident.push_back(resident_MB());
    std::printf("visitor %d: %.1f MB, %llu frames, late p50 %.0f us\n", i + 1, resident_MB(),
                static_cast<unsigned long long>(app_->view().frames.times.percentiles().count),
                app_->session().loop().statistics().lateness.p50_us);
  }
  // What screens, threads and the driver allocate once comes with some of the visitors; a leak is in every visit.
  std::adjacent_difference(resident.begin(), resident.end(), resident.begin());
  ASSERT_GT(resident.size(), 2u);
  EXPECT_LT(*std::min_element(resident.begin() + 2, resident.end()), 1.0) << "MB: memory grows with every visitor";
}

TEST_F(ExhibitTest, NobodyIsThrownOutWhileReading) {
  open_exhibit({{1.0, 3.0, 2.0, 0.5}});
  visit_with_keys();
  ASSERT_TRUE(until([&] { return says("Ends in "); })) << "a countdown";
  move(block(0, 10.0F));
  EXPECT_FALSE(says("Ends in ")) << "any movement begins it anew";
  EXPECT_EQ(state(), State::score);
  ASSERT_TRUE(until([&] { return state() == State::attract; }));
}

TEST_F(ExhibitTest, LanguagesHaveKeysOfTheirOwnAndTheHostsFiguresAreHidden) {
  open_exhibit({});
  EXPECT_FALSE(says("tick p99"));
  press(GLFW_KEY_T, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  EXPECT_TRUE(says("tick p99") || says("deadlines"));
  press(GLFW_KEY_T, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
  EXPECT_FALSE(says("tick p99"));
  press(GLFW_KEY_L);
  EXPECT_TRUE(says("Kannst du Computer und Block unterscheiden?"));
}

// With two models the better one stands for the block.
TEST_F(ExhibitTest, AForceDeviceIsComparedBlindly) {
  open_exhibit({{1.0, 300.0, 2.0, 0.5}, &bus_});
  press(GLFW_KEY_Z);
  ASSERT_TRUE(until([&] { return app_->session().newest().device.may_push(); }));
  pictures_ = "felt-";
  press(GLFW_KEY_1);
  ASSERT_EQ(state(), State::press);
  EXPECT_TRUE(app_->exhibit().is_blind());
  stroke_device();
  EXPECT_FALSE(game().can_answer()) << "both have to be pressed";
  const std::size_t one = app_->session().models().selected();
  press(GLFW_KEY_RIGHT);
  for (int i = 0; i < 20 && !game().can_answer(); ++i) {
    stroke_device();
    if (i == 0) press(GLFW_KEY_LEFT);
    if (i == 9) press(GLFW_KEY_RIGHT);
  }
  EXPECT_NE(app_->session().models().selected(), one);
  ASSERT_TRUE(until([&] { return shows("1"); }));
  EXPECT_TRUE(says("worse computer"));
  picture("press");
  press(GLFW_KEY_1);
  ASSERT_EQ(state(), State::reveal);
  ASSERT_TRUE(until([&] { return shows("Enter"); }));
  press(GLFW_KEY_ENTER);
  ASSERT_EQ(state(), State::score);
  picture("score");
}

}  // namespace
}  // namespace palpate
