#include "scenes/scene/jnd_file.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

std::string complaint(const std::string& text) {
  const auto line = parse_jnd_file(text, "jnd.json");
  return line.ok() ? "accepted" : line.error().message;
}

TEST(JndFile, ReadsBackWhatWasWritten) {
  const JndLines lines{{0.0712345678901, 0.1234567890123}, {0.1 / 3.0, 0.1234567890123}};
  const std::string text =
      jnd_file_text(lines, {{0.3, 0.09, 0.01, "study"}, {2.5, 0.225, 0.0, "a paper"}}, 0.75, {"S01", "S02"});
  const auto line = parse_jnd_file(text, "jnd.json");
  ASSERT_TRUE(line.ok()) << line.error().message;
  EXPECT_EQ(line->offset_N, 0.1 / 3.0);
  EXPECT_EQ(line->weber_fraction, 0.1234567890123);
  EXPECT_NE(text.find("\"standard_error_N\": 0.01"), std::string::npos);
  EXPECT_EQ(text.find("\"standard_error_N\": 0.0,"), std::string::npos) << "none known, none told";
}

TEST(JndFile, RefusesWithPlaceFoundAndExpected) {
  const std::string advice = "; write it anew with palpate study analyse";
  const std::string start = "{\"format\": \"palpate-jnd\",\n\"version\": 1,\n";
  EXPECT_EQ(complaint(start + "\"offset_N\": 0.1, \"weber_fraction\": 0}"), "accepted");
  EXPECT_EQ(complaint("[]"), "jnd.json:1:1: found no \"format\": \"palpate-jnd\", expected a JND file" + advice);
  EXPECT_EQ(complaint("{\"format\": 3}"),
            "jnd.json:1:1: found no \"format\": \"palpate-jnd\", expected a JND file" + advice);
  EXPECT_EQ(complaint("{\"format\": \"palpate-jnd\",\n\"version\": 2}"),
            "jnd.json:2:12: version: found 2, expected the version 1" + advice);
  EXPECT_EQ(complaint(start + "\"weber_fraction\": 0}"),
            "jnd.json:1:1: offset_N: found no such field, expected a number above 0 up to 100" + advice);
  EXPECT_EQ(complaint(start + "\"offset_N\": 0, \"weber_fraction\": 0}"),
            "jnd.json:3:13: offset_N: found 0, expected a number above 0 up to 100" + advice);
  EXPECT_EQ(complaint(start + "\"offset_N\": 0.1, \"weber_fraction\": \"6 %\"}"),
            "jnd.json:3:36: weber_fraction: found \"6 %\", expected a number from 0 up to 1" + advice);
  const std::string broken = complaint(start);
  EXPECT_EQ(broken.substr(0, 14), "jnd.json:3:1: ") << broken;
  EXPECT_EQ(read_jnd_file("/none/jnd.json").error().message, "cannot read the JND file /none/jnd.json; does it exist?");
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
