#include "scenes/plot/draw.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(Gnuplot, RunsScriptsInTheirFolder) {
  const Status found = find_gnuplot();
  ASSERT_TRUE(found.ok()) << found.error().message;
  const test::TemporaryFolder folder;
  folder.with_file("a.gp", "set print 'a.txt'\nprint 1.5\n");
  const Status status = run_gnuplot(folder.path(), "a.gp");
  EXPECT_TRUE(status.ok()) << status.error().message;
  EXPECT_EQ(test::read_text(folder.file("a.txt")), "1.5\n");
}

TEST(Gnuplot, SaysWhatItDidNotUnderstand) {
  const test::TemporaryFolder folder;
  folder.with_file("a.gp", "dance\n");
  const Status status = run_gnuplot(folder.path(), "a.gp");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message.rfind("gnuplot could not draw a.gp: ", 0), 0u) << status.error().message;
}

TEST(Gnuplot, MissingIsToldBeforeAnyWork) {
  const test::TemporaryFolder folder;
  const auto ran = test::run_palpate({"report", "--quick", "--out", folder.file("report")}, {"PATH=" + folder.path()});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_EQ(ran.err,
            "error: found no gnuplot in PATH, which draws the figures; install it (Debian: apt-get install "
            "gnuplot-nox)\n");
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace palpate
