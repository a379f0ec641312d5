#include "scenes/study/jnd_lines.h"

#include <gtest/gtest.h>

#include "scenes/scene/jnd_file.h"

namespace palpate {
namespace {

TEST(JndFile, ReadsBackWhatWasWritten) {
  const JndLines lines{{0.0712345678901, 0.1234567890123}, {0.1 / 3.0, 0.1234567890123}};
  const std::string text =
      jnd_file_text(lines, {{0.3, 0.09, 0.01, "study"}, {2.5, 0.225, 0.0, "a paper"}}, {"S01", "S02"});
  const auto line = parse_jnd_file(text, "jnd.json");
  ASSERT_TRUE(line.ok()) << line.error().message;
  EXPECT_EQ(line->offset_N, 0.1 / 3.0);
  EXPECT_EQ(line->weber_fraction, 0.1234567890123);
  EXPECT_NE(text.find("\"standard_error_N\": 0.01"), std::string::npos);
  EXPECT_EQ(text.find("\"standard_error_N\": 0.0,"), std::string::npos) << "none known, none told";
}

TEST(JndLineFit, FitsByLeastSquaresAndShiftsBelowAllPoints) {
  const auto lines = fit_jnd_lines({{0.0, 0.1, 0.0, "study"}, {1.0, 0.3, 0.0, "study"}, {2.0, 0.2, 0.0, "study"}});
  ASSERT_TRUE(lines.ok()) << lines.error().message;
  EXPECT_NEAR(lines->fitted.weber_fraction, 0.05, 1e-12);
  EXPECT_NEAR(lines->fitted.offset_N, 0.15, 1e-12);
  EXPECT_NEAR(lines->conservative.weber_fraction, 0.05, 1e-12);
  EXPECT_NEAR(lines->conservative.offset_N, 0.1, 1e-12);
}

TEST(JndLineFit, RefusesLinesThatNothingCanBeJudgedBy) {
  EXPECT_EQ(fit_jnd_lines({}).error().message,
            "found JNDs at fewer than two reference forces, expected two or more for a line");
  EXPECT_FALSE(fit_jnd_lines({{1.0, 0.1, 0.0, "study"}, {1.0, 0.2, 0.0, "study"}}).ok());
  EXPECT_EQ(fit_jnd_lines({{1.0, 0.3, 0.0, "study"}, {2.0, 0.2, 0.0, "study"}}).error().message,
            "the conservative line through the JNDs is 0.4000 N + -10.00 %, expected JNDs that do not fall with the "
            "force; more subjects or more trials may help");
  EXPECT_EQ(fit_jnd_lines({{1.0, 0.1, 0.0, "study"}, {2.0, 0.3, 0.0, "study"}}).error().message,
            "the conservative line through the JNDs is -0.1000 N + 20.00 %, expected one that is above 0 N at no "
            "force; more subjects or more trials may help");
}

TEST(JndLineFit, KnowsThePublishedPoint) {
  const std::vector<JndPoint> points = pang_tan_durlach_points();
  ASSERT_EQ(points.size(), 1u);
  EXPECT_DOUBLE_EQ(points[0].jnd_N / points[0].reference_N, 0.09);
}

}  // namespace
}  // namespace palpate
