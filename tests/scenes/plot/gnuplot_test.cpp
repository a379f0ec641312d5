#include "scenes/plot/draw.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(Gnuplot, ErrorsHaveItsFirstLine) {
  const test::TemporaryFolder folder;
  folder.with_file("a.gp", "dance\n");
  const Status status = run_gnuplot(folder.path(), "a.gp");
  ASSERT_FALSE(status.ok());
  EXPECT_TRUE(test::has_parts(status.error().message, {"a.gp"})) << status.error().message;
}

TEST(Gnuplot, IsCheckedBeforeAnyWork) {
  const test::TemporaryFolder folder;
  const auto ran = test::run_palpate({"report", "--quick", "--out", folder.file("report")}, {"PATH=" + folder.path()});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_TRUE(test::has_parts(ran.err, {"error: ", "PATH", "apt-get install gnuplot-nox"}));
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace palpate
