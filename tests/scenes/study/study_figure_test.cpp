#include "scenes/study/study_figure.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

StudyAnalysis example() {
  StudyAnalysis analysis;
  analysis.subjects.push_back({"S01", ProcedureKind::constant, 0, {{0.3, 0.3, 80, {0.09, 0.07, 0.12, true}}, {2.5, 2.5, 80, {0.4, 0.1, 9.0, false}}}});
  analysis.points = {{0.3, 0.09, 0.01, "study"}, {2.5, 0.3, 0.02, "study"}, {2.5, 0.225, 0.0, "Pang, Tan & Durlach (1991)"}};
  analysis.lines = JndLines{{0.07, 0.08}, {0.065, 0.08}};
  return analysis;
}

TEST(StudyFigure, TheScriptHoldsDataAndLines) {
  const std::string script = study_figure_script(example(), "folder/figure3");
  EXPECT_NE(script.find("$study << END\n0.3 0.09 0.01 30 3.33333\n2.5 0.3 0.02 12 0.8\nEND\n"), std::string::npos) << script;
  EXPECT_NE(script.find("$published << END\n2.5 0.225 0 9 0\nEND\n"), std::string::npos);
  EXPECT_NE(script.find("$subjects << END\n0.3 0.09 30\nEND\n"), std::string::npos) << "only what is determined";
  EXPECT_NE(script.find("conservative(x) = 0.065 + 0.08 * x"), std::string::npos);
  EXPECT_NE(script.find("paper(x) = 0.065 + 0.0633 * x"), std::string::npos);
  for (const char* name : {"figure3a.svg", "figure3a.png", "figure3b.svg", "figure3b.png"}) {
    EXPECT_NE(script.find(std::string("set output 'folder/") + name + "'"), std::string::npos) << name;
  }
}

TEST(StudyFigure, WithoutALineThereAreStillThePoints) {
  StudyAnalysis analysis = example();
  analysis.lines = Error{"none"};
  analysis.points.pop_back();
  const std::string script = study_figure_script(analysis, "figure3");
  EXPECT_EQ(script.find("conservative"), std::string::npos);
  EXPECT_EQ(script.find("Pang"), std::string::npos);
}

TEST(StudyFigure, OverwritesNothingAndRefusesOddFolders) {
  const test::TemporaryFolder folder;
  const std::string old = folder.with_file("figure3b.svg", "old");
  EXPECT_EQ(write_study_figures(example(), folder.path(), false).error().message, old + " exists; pass --force to replace it");
  EXPECT_EQ(test::read_text(old), "old");
  EXPECT_FALSE(write_study_figures(example(), "a'b", true).ok());
}

}  // namespace
}  // namespace palpate
