#include "scenes/report/publish.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(ReportFolder, AppearsWholeOnCommit) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("report");
  auto report = ReportFolder::create(out + "/", false);
  ASSERT_TRUE(report.ok()) << report.error().message;
  ASSERT_TRUE(report->write("report.json", "{}").ok());
  ASSERT_TRUE(report->write("tables/a.csv", "x\n").ok());
  EXPECT_FALSE(std::filesystem::exists(out));
  ASSERT_TRUE(report->commit().ok());
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"report"});
  EXPECT_EQ(test::read_text(out + "/tables/a.csv"), "x\n");
}

TEST(ReportFolder, ReplacesAnEarlierReportOnlyWhenForced) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("report");
  std::filesystem::create_directory(out);
  folder.with_file("report/report.json", "old");
  folder.with_file("report/old.csv", "old");
  const auto refused = ReportFolder::create(out, false);
  ASSERT_FALSE(refused.ok());
  EXPECT_TRUE(test::has_parts(refused.error().message, {out, "--force"}));
  {
    auto dropped = ReportFolder::create(out, true);
    ASSERT_TRUE(dropped.ok());
    ASSERT_TRUE(dropped->write("report.json", "new").ok());
  }
  EXPECT_EQ(test::read_text(out + "/report.json"), "old") << "not committed";
  auto report = ReportFolder::create(out, true);
  ASSERT_TRUE(report.ok());
  ASSERT_TRUE(report->write("report.json", "new").ok());
  ASSERT_TRUE(report->commit().ok());
  EXPECT_EQ(test::read_text(out + "/report.json"), "new");
  EXPECT_FALSE(std::filesystem::exists(out + "/old.csv"));
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"report"});
}

TEST(ReportFolder, NeverTakesTheWayOfSomethingElse) {
  const test::TemporaryFolder folder;
  const std::string home = folder.file("home");
  std::filesystem::create_directory(home);
  folder.with_file("home/thesis.txt", "mine");
  const auto message = [](const std::string& path) {
    const auto refused = ReportFolder::create(path, true);
    return refused.ok() ? "" : refused.error().message;
  };
  EXPECT_TRUE(test::has_parts(message(home), {home, "report.json", "folder"}));
  const std::string file = folder.with_file("file", "mine");
  EXPECT_TRUE(test::has_parts(message(file), {file, "folder", "--out"}));
  EXPECT_TRUE(test::has_parts(message(folder.file("none/report")),
                              {folder.file("none/report"), "folder", folder.file("none"), "; "}));
  EXPECT_NE(message(""), "");
  EXPECT_NE(message(".."), "");
  EXPECT_EQ(test::read_text(folder.file("home/thesis.txt")), "mine");
}

}  // namespace
}  // namespace palpate
