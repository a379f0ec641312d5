#include "scenes/report/publish.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <regex>

#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

Table example() {
  const double none = std::numeric_limits<double>::quiet_NaN();
  return {"example",
          false,
          {{"model", "model"}, {"count", "count"}, {"rms_error_N", "RMS [mN]", 1e3}, {"share", "share [%]", 100.0, 2}},
          {{std::string("a,\"b\""), std::uint64_t{12345}, 0.1, 0.99954},
           {std::string("<i>"), std::uint64_t{0}, none, 1.0}}};
}

TEST(Table, CsvHoldsTheStoredValuesInFull) {
  EXPECT_EQ(table_csv(example()), "model,count,rms_error_N,share\n\"a,\"\"b\"\"\",12345,0.1,0.99954\n<i>,0,,1\n");
}

TEST(Table, JsonHasNullForNoFigure) {
  EXPECT_EQ(table_json(example()).dump(),
            "[{\"model\":\"a,\\\"b\\\"\",\"count\":12345,\"rms_error_N\":0.1,\"share\":0.99954},"
            "{\"model\":\"<i>\",\"count\":0,\"rms_error_N\":null,\"share\":1.0}]");
}

TEST(Table, AnIntervalStandsUnderItsFigureAndInTheFileBesideIt) {
  const Table table{"example",
                    false,
                    {{"share", "share [%]", 100.0, 1, 2}, {"share_low", "", 100.0, 1}, {"share_high", "", 100.0, 1}},
                    {{0.5, 0.25, 0.75}}};
  EXPECT_EQ(table_csv(table), "share,share_low,share_high\n0.5,0.25,0.75\n");
  EXPECT_TRUE(test::has_parts(table_html(table), {"<td>50.0<small>25.0–75.0</small></td></tr>"}));
}

TEST(Pages, TheFrontPageSaysTheRuleAndTheJndAsThePagesDo) {
  const std::string text =
      std::regex_replace(test::read_text(PALPATE_SOURCE_DIR "/README.md"), std::regex("\\s+"), " ");
  const std::string jnd = kJndDefinition;
  EXPECT_TRUE(test::has_parts(text, {jnd.substr(1, jnd.find(';') - 1), kBestRule}));
}

TEST(ReportFolder, AppearsWholeOnCommit) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("report");
  auto report = test::must(ReportFolder::create(out + "/", false));
  ASSERT_TRUE(report.write("report.json", "{}").ok());
  ASSERT_TRUE(report.write("tables/a.csv", "x\n").ok());
  EXPECT_FALSE(std::filesystem::exists(out));
  ASSERT_TRUE(report.commit().ok());
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"report"});
  EXPECT_EQ(test::read_text(out + "/tables/a.csv"), "x\n");
}

TEST(ReportFolder, ReplacesAnEarlierReportOnlyWhenForced) {
  const test::TemporaryFolder folder;
  const std::string out = folder.file("report");
  std::filesystem::create_directory(out);
  folder.with_file("report/report.json", "old");
  folder.with_file("report/old.csv", "old");
  EXPECT_TRUE(test::has_parts(ReportFolder::create(out, false), {out, "--force"}));
  {
    auto dropped = test::must(ReportFolder::create(out, true));
    ASSERT_TRUE(dropped.write("report.json", "new").ok());
  }
  EXPECT_EQ(test::read_text(out + "/report.json"), "old") << "not committed";
  auto report = test::must(ReportFolder::create(out, true));
  ASSERT_TRUE(report.write("report.json", "new").ok());
  ASSERT_TRUE(report.commit().ok());
  EXPECT_EQ(test::read_text(out + "/report.json"), "new");
  EXPECT_FALSE(std::filesystem::exists(out + "/old.csv"));
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"report"});
}

TEST(ReportFolder, RemovesTheFoldersOfKilledPrograms) {
  const test::TemporaryFolder folder;
  for (const std::string name :
       {".palpate-report-AbC123", ".palpate-report-AbC123.old", ".palpate-report-", "report-AbC123"}) {
    std::filesystem::create_directory(folder.file(name));
    folder.with_file(name + "/report.json", "{}");
  }
  auto running = test::must(ReportFolder::create(folder.file("other"), false));
  ASSERT_TRUE(running.write("report.json", "{}").ok());
  const std::size_t all = folder.entries().size();
  EXPECT_EQ(all, 5u) << "a new folder may be locked next";
  for (const std::string& name : folder.entries()) {
    std::filesystem::last_write_time(folder.file(name),
                                     std::filesystem::file_time_type::clock::now() - std::chrono::minutes(1));
  }
  test::must(ReportFolder::create(folder.file("report"), false));
  EXPECT_FALSE(std::filesystem::exists(folder.file(".palpate-report-AbC123")));
  EXPECT_EQ(folder.entries().size(), all - 1);
  EXPECT_TRUE(running.commit().ok());
}

TEST(ReportFolder, NeverTakesTheWayOfSomethingElse) {
  const test::TemporaryFolder folder;
  const std::string home = folder.file("home");
  std::filesystem::create_directory(home);
  folder.with_file("home/thesis.txt", "mine");
  const auto refused = [](const std::string& path) { return test::message_of(ReportFolder::create(path, true)); };
  EXPECT_TRUE(test::has_parts(refused(home), {home, "report.json", "folder"}));
  const std::string file = folder.with_file("file", "mine");
  EXPECT_TRUE(test::has_parts(refused(file), {file, "folder", "--out"}));
  EXPECT_TRUE(test::has_parts(refused(folder.file("none/report")),
                              {folder.file("none/report"), "folder", folder.file("none"), "; "}));
  EXPECT_NE(refused(""), "accepted");
  EXPECT_NE(refused(".."), "accepted");
  EXPECT_EQ(test::read_text(folder.file("home/thesis.txt")), "mine");
}

}  // namespace
}  // namespace palpate
