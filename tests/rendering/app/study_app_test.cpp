// The window of the study on a virtual display, from entering the code to a stored answer.
#include "rendering/app/study_app.h"

#include <epoxy/gl.h>
// Included after epoxy, which declares OpenGL's functions.
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "scenes/study/study_analysis.h"
#include "scenes/study/study_file.h"
#include "tests/support/message_parts.h"
#include "tests/support/study_driving.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace palpate {
namespace {

constexpr double kPatience_s = 60.0;

class StudyAppTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(test::virtual_display().empty()) << "Xvfb does not start; apt-get install xvfb";
    before_ = std::filesystem::current_path();
    std::filesystem::current_path(folder_.path());
    start(nullptr);
  }
  void start(std::shared_ptr<const StrokePair> strokes) {
    app_.reset();
    std::function<StudyApp::Strokes()> prepare;
    if (strokes) prepare = [&]() -> StudyApp::Strokes { return strokes; };
    auto app = StudyApp::create({}, "hand", prepare, false);  // tests do not need real-time priority
    ASSERT_TRUE(app.ok()) << app.error().message;
    app_ = std::move(*app);
    app_->frame();
  }
  void TearDown() override {
    app_.reset();
    std::filesystem::current_path(before_);
  }
  bool until(StudyState state) {
    const auto start = std::chrono::steady_clock::now();
    while (app_->session()->state() != state) {
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > kPatience_s) return false;
      app_->frame();
    }
    return true;
  }
  void press(int key) {
    app_->press_key(key);
    app_->frame();
  }
  void begin(const std::string& code) {
    for (const char letter : code) app_->type(letter);
    press(GLFW_KEY_ENTER);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path before_;
  std::unique_ptr<StudyApp> app_;
};

TEST_F(StudyAppTest, StoresTheAnswerToForcesAndToStrokes) {
  for (const bool strokes : {false, true}) {
    start(strokes ? test::example_strokes(0.8) : nullptr);
    begin("S01");
    ASSERT_NE(app_->session(), nullptr) << app_->problem();
    EXPECT_EQ(app_->session()->state(), StudyState::consent);
    press(GLFW_KEY_Y);
    ASSERT_TRUE(until(StudyState::ready));
    press(GLFW_KEY_ENTER);
    ASSERT_TRUE(until(StudyState::answering));
    const StudyTrial trial = app_->session()->trial();
    const bool second = strokes ? test::truly_like(trial) : test::truly_larger(trial);
    app_->frame();
    press(GLFW_KEY_1);
    EXPECT_EQ(app_->session()->state(), StudyState::answering) << "a slip of the finger";
    for (int i = 0; i < 20; ++i) app_->frame();
    press(second ? GLFW_KEY_2 : GLFW_KEY_1);
    ASSERT_TRUE(until(StudyState::presenting));
    EXPECT_EQ(app_->session()->view().was_correct, true);
    press(GLFW_KEY_ESCAPE);
    EXPECT_NE(app_->session()->state(), StudyState::aborted) << "it asks";
    press(GLFW_KEY_E);
    EXPECT_EQ(app_->session()->state(), StudyState::aborted);
    press(GLFW_KEY_ENTER);
    EXPECT_TRUE(app_->closing());
    app_.reset();
    const Result data = test::must(read_study(strokes ? "discriminate-S01.csv" : "study-S01.csv"));
    ASSERT_EQ(data->records.size(), 1u);
    const StudyRecord& record = data->records.front();
    EXPECT_EQ(record.answered_second, second);
    // The device received the commanded forces without limiting.
    EXPECT_NEAR(record.first_rendered_N, trial.first_N(), 1e-3);
    EXPECT_NEAR(record.second_rendered_N, trial.second_N(), 1e-3);
    EXPECT_NEAR(record.reminder_rendered_N, strokes ? trial.reference_N : 0.0, 1e-3);
    EXPECT_LT(record.worst_N, 1e-3);
  }
}

TEST_F(StudyAppTest, EndsWithoutTheResult) {
  const StudyHeader header{"S01", test::example_strokes(0.8)};
  {
    auto file = StudyFile::open("discriminate-S01.csv", header);
    ASSERT_TRUE(file.ok() && file->consent("").ok());
    for (const StudyRecord& record : simulated_answers(header, {}, 1)) ASSERT_TRUE(file->append(record).ok());
  }
  start(header.strokes);
  begin("S01");
  ASSERT_NE(app_->session(), nullptr) << app_->problem();
  EXPECT_EQ(app_->session()->state(), StudyState::done);
  app_->frame();
}

}  // namespace
}  // namespace palpate
