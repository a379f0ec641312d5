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
  analysis.subjects.push_back({"S01", ProcedureKind::constant, 0, {{0.3, 0.3, 80, {0.09, 0.07, 0.12, true}}, {2.5, 2.5, 80, {0.4, 0.1, 9.0, false}}}});
  analysis.points = {{0.3, 0.09, 0.01, "study"}, {2.5, 0.3, 0.02, "study"}, {2.5, 0.225, 0.0, "Pang, Tan & Durlach (1991)"}};
  analysis.lines = JndLines{{0.07, 0.08}, {0.065, 0.08}};
  return analysis;
}

TEST(StudyFigure, TheScriptHoldsDataAndLines) {
  const std::string script = study_figure_script(example());
  EXPECT_NE(script.find("$study << END\n0.3 0.09 0.01 30 3.33333\n2.5 0.3 0.02 12 0.8\nEND\n"), std::string::npos) << script;
  EXPECT_NE(script.find("$published << END\n2.5 0.225 0 9 0\nEND\n"), std::string::npos);
  EXPECT_NE(script.find("$subjects << END\n0.3 0.09 30\nEND\n"), std::string::npos) << "only what is determined";
  EXPECT_NE(script.find("conservative(x) = 0.065 + 0.08 * x"), std::string::npos);
  EXPECT_NE(script.find("paper(x) = 0.065 + 0.0633 * x"), std::string::npos);
  for (const char* name : {"figure3a.svg", "figure3a.png", "figure3b.svg", "figure3b.png"}) {
    EXPECT_NE(script.find(std::string("set output '") + name + "'"), std::string::npos) << name;
  }
}

TEST(StudyFigure, WithoutALineThereAreStillThePoints) {
  StudyAnalysis analysis = example();
  analysis.lines = Error{"none"};
  analysis.points.pop_back();
  const std::string script = study_figure_script(analysis);
  EXPECT_EQ(script.find("conservative"), std::string::npos);
  EXPECT_EQ(script.find("Pang"), std::string::npos);
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
  const std::string old = folder.with_file("figure3b.svg", "old");
  EXPECT_EQ(write_study_figures(example(), folder.path(), false).error().message, old + " exists; pass --force to replace it");
  EXPECT_EQ(test::read_text(old), "old");
}

TEST(StudyFigure, AFailureInTheMiddleLeavesNoHalfOfAFigure) {
  const test::TemporaryFolder folder;
  const ProgramInPath gnuplot(folder, "echo half > figure3a.svg\necho 'line 9: no such terminal' >&2\nexit 1\n");
  const std::string old = folder.with_file("figure3a.svg", "old");
  const Status status = write_study_figures(example(), folder.path(), true);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("line 9: no such terminal"), std::string::npos) << status.error().message;
  EXPECT_EQ(test::read_text(old), "old");
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"bin", "figure3.gp", "figure3a.svg"}));
}

TEST(StudyFigure, OneThatIsMissingIsToldAndNoneIsTaken) {
  const test::TemporaryFolder folder;
  const ProgramInPath gnuplot(folder, "echo a > figure3a.svg; echo a > figure3a.png; echo b > figure3b.svg\n");
  EXPECT_FALSE(write_study_figures(example(), folder.path(), false).ok());
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"bin", "figure3.gp"}));
}

TEST(StudyFigure, AllOfThemComeTogether) {
  const test::TemporaryFolder folder;
  const ProgramInPath gnuplot(folder, "for f in figure3a figure3b; do echo svg > $f.svg; echo png > $f.png; done\n");
  const Status status = write_study_figures(example(), folder.path(), false);
  ASSERT_TRUE(status.ok()) << status.error().message;
  EXPECT_EQ(test::read_text(folder.file("figure3b.png")), "png\n");
  EXPECT_EQ(folder.entries().size(), 6u) << "bin, the script and four figures";
}

}  // namespace
}  // namespace palpate
