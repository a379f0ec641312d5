// The study's window on a display in memory, from the code to a stored answer.
#include "rendering/study_app.h"

#include <epoxy/gl.h>
// After epoxy, which brings OpenGL's functions.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "scenes/study/study_file.h"
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
    StudyRequest request;
    request.device = "hand";
    request.realtime = false;  // a test does not outrank the machine it runs on
    auto app = StudyApp::create(request);
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
    while (app_->study()->session().state() != state) {
      if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > kPatience_s)
        return false;
      app_->frame();
    }
    return true;
  }
  void press(int key) {
    app_->press_key(key);
    app_->frame();
  }

  test::TemporaryFolder folder_;
  std::filesystem::path before_;
  std::unique_ptr<StudyApp> app_;
};

TEST_F(StudyAppTest, GoesFromTheConsentToAStoredAnswer) {
  app_->begin("S01", ProcedureKind::constant);
  ASSERT_NE(app_->study(), nullptr) << app_->problem();
  EXPECT_EQ(app_->study()->session().state(), StudyState::consent);
  press(GLFW_KEY_Y);
  ASSERT_TRUE(until(StudyState::ready));
  press(GLFW_KEY_ENTER);
  ASSERT_TRUE(until(StudyState::presenting));
  ASSERT_TRUE(until(StudyState::answering));
  press(GLFW_KEY_1);
  ASSERT_TRUE(until(StudyState::presenting));
  press(GLFW_KEY_ESCAPE);
  EXPECT_EQ(app_->study()->session().state(), StudyState::aborted);
  app_.reset();
  const auto data = read_study("study-S01.csv");
  ASSERT_TRUE(data.ok()) << data.error().message;
  ASSERT_EQ(data->records.size(), 1u);
  const StudyRecord& record = data->records.front();
  EXPECT_FALSE(record.answered_second);
  // What the device got is what was asked for: nothing was held back.
  EXPECT_NEAR(record.first_rendered_N, record.trial.first_N(), 1e-3);
  EXPECT_NEAR(record.second_rendered_N, record.trial.second_N(), 1e-3);
}

TEST_F(StudyAppTest, SaysWhatIsWrongWithACode) {
  app_->begin("Anna", ProcedureKind::adaptive);
  EXPECT_EQ(app_->study(), nullptr);
  EXPECT_NE(app_->problem().find("Anna"), std::string::npos) << app_->problem();
  app_->frame();
  EXPECT_FALSE(app_->closing());
}

}  // namespace
}  // namespace palpate
