#include "scenes/study/study_figure.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdlib>
#include <filesystem>

#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

StudyAnalysis example() {
  StudyAnalysis analysis;
  analysis.subjects.push_back({"S01", 0, {{0.3, 0.3, 80, 0.09, true}, {2.5, 2.5, 80, 0.4, false}}});
  analysis.points = {
      {0.3, 0.09, 0.01, "study"}, {2.5, 0.3, 0.02, "study"}, {2.5, 0.225, 0.0, "Pang, Tan & Durlach (1991)"}};
  analysis.lines = JndLines{{0.07, 0.08}, {0.065, 0.08}};
  return analysis;
}

std::vector<std::string> names(const Panel& panel) {
  std::vector<std::string> list;
  for (const Series& series : panel.series) list.push_back(series.name);
  return list;
}

TEST(StudyFigure, HoldsPointsAndLinesAsTheyAreAndInPerCent) {
  const Plot plot = study_plot(example());
  ASSERT_EQ(plot.panels.size(), 2u);
  const std::vector<Series>& a = plot.panels[0].series;
  const std::vector<Series>& b = plot.panels[1].series;
  EXPECT_EQ(names(plot.panels[0]),
            (std::vector<std::string>{"Hoever & Harders (2009): 0.065 N + 6.33 %", "fitted: 0.070 N + 8.00 %",
                                      "conservative: 0.065 N + 8.00 %", "single subjects",
                                      "mean of subjects, standard error", "Pang, Tan & Durlach (1991)"}));
  ASSERT_EQ(a[3].rows.size(), 1u) << "only what is determined";
  EXPECT_NEAR(b[3].rows[0].y, 30.0, 1e-9);
  ASSERT_EQ(a[4].rows.size(), 2u);
  EXPECT_NEAR(a[4].rows[0].low, 0.08, 1e-12);
  EXPECT_NEAR(b[4].rows[0].high, 100.0 / 3.0, 1e-9);
  EXPECT_NEAR(b[5].rows[0].y, 9.0, 1e-9);
  for (const PlotRow& row : b[0].rows) EXPECT_NEAR(row.y, 100.0 * (0.065 / row.x + 0.0633), 1e-9);
}

TEST(StudyFigure, WithoutALineThereAreStillThePoints) {
  StudyAnalysis analysis = example();
  analysis.lines = Error{"none"};
  analysis.points.pop_back();
  EXPECT_EQ(names(study_plot(analysis).panels[0]),
            (std::vector<std::string>{"Hoever & Harders (2009): 0.065 N + 6.33 %", "single subjects",
                                      "mean of subjects, standard error", ""}));
}

// In front of every other program for as long as it lives.
class ProgramInPath {
 public:
  ProgramInPath(const test::TemporaryFolder& folder, const std::string& script) : before_(std::getenv("PATH")) {
    std::filesystem::create_directory(folder.file("bin"));
    const std::string program = folder.with_file("bin/gnuplot", "#!/bin/sh\n" + script);
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    setenv("PATH", (folder.file("bin") + ":" + before_).c_str(), 1);
  }
  ProgramInPath(const ProgramInPath&) = delete;
  ProgramInPath& operator=(const ProgramInPath&) = delete;
  ~ProgramInPath() { setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

TEST(StudyFigure, OverwritesNothing) {
  const test::TemporaryFolder folder;
  const std::string old = folder.with_file("figure3.svg", "old");
  EXPECT_EQ(write_study_figures(example(), folder.path(), false).error().message,
            old + " exists; pass --force to replace it");
  EXPECT_EQ(test::read_text(old), "old");
}

TEST(StudyFigure, AFailureInTheMiddleLeavesNoHalfOfAFigure) {
  const test::TemporaryFolder folder;
  const ProgramInPath gnuplot(folder, "echo half > figure3.svg\necho 'line 9: no such terminal' >&2\nexit 1\n");
  const std::string old = folder.with_file("figure3.svg", "old");
  const Status status = write_study_figures(example(), folder.path(), true);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("line 9: no such terminal"), std::string::npos) << status.error().message;
  EXPECT_EQ(test::read_text(old), "old");
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"bin", "figure3.gp", "figure3.svg"}));
}

TEST(StudyFigure, OneThatIsMissingIsToldAndNoneIsTaken) {
  const test::TemporaryFolder folder;
  const ProgramInPath gnuplot(folder, "echo a > figure3.svg\n");
  EXPECT_FALSE(write_study_figures(example(), folder.path(), false).ok());
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"bin", "figure3.gp"}));
}

TEST(StudyFigure, AllOfThemComeTogether) {
  const test::TemporaryFolder folder;
  const ProgramInPath gnuplot(folder, "echo svg > figure3.svg; echo png > figure3.png\n");
  const Status status = write_study_figures(example(), folder.path(), false);
  ASSERT_TRUE(status.ok()) << status.error().message;
  EXPECT_EQ(test::read_text(folder.file("figure3.png")), "png\n");
  EXPECT_EQ(folder.entries().size(), 4u) << "bin, the script and two figures";
}

}  // namespace
}  // namespace palpate
