#include "scenes/report/page/page.h"

#include <gtest/gtest.h>

#include "scenes/report/page/tables.h"

namespace palpate {
namespace {

ReportData example() {
  ReportData data;
  data.scene = "<scene>";
  data.test_names = {"a"};
  return data;
}

std::string page_of(const ReportData& data) {
  ReportOrigin origin;
  origin.command_line = "palpate report --out 'a<b'";
  std::vector<Table> tables{{"recordings", "caption", false, {{"recording", "recording"}}, {{std::string("<script>")}}}};
  if (data.hard_cases) tables.push_back(*data.hard_cases);
  Figure figure;
  figure.name = "jnd";
  figure.title = "The JND";
  const auto page = make_page(data, origin, tables, {figure}, {{"jnd", "<svg viewBox=\"0 0 1 1\"><g id=\"x\"/></svg>"}});
  EXPECT_TRUE(page.ok()) << page.error().message;
  return page.ok() ? *page : std::string();
}

TEST(Page, EscapesWhatComesFromOutside) {
  const std::string page = page_of(example());
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;"), std::string::npos);
  EXPECT_NE(page.find("&lt;scene&gt;"), std::string::npos);
  EXPECT_NE(page.find("&#39;a&lt;b&#39;"), std::string::npos);
  EXPECT_NE(page.find("<g id=\"jnd-x\"/>"), std::string::npos);
}

TEST(Page, SaysHowItWasTested) {
  ReportData data = example();
  EXPECT_EQ(page_of(data).find("cross-validation"), std::string::npos);
  data.folds = 3;
  data.quick = true;
  const std::string page = page_of(data);
  EXPECT_NE(page.find("There was no test recording. Every error here is from 3-fold cross-validation"),
            std::string::npos);
  EXPECT_NE(page.find("A quick report"), std::string::npos);
}

TEST(Page, SumsUpTheHardCasesWhenThereAreAny) {
  ReportData data = example();
  EXPECT_EQ(page_of(data).find("Hard cases"), std::string::npos);
  HardCaseResult result;
  result.name = "two sites";
  result.method = "greedy";
  result.worst_over_jnd = 3.0;
  result.safe = true;
  data.hard_cases = hard_case_table({result});
  const std::string page = page_of(data);
  EXPECT_NE(page.find("1 of 1 made-up hard cases"), std::string::npos);
  EXPECT_NE(page.find("greedy with &quot;two sites&quot;, 3.00 JND"), std::string::npos);
}

TEST(Page, EveryFigureHasItsDataOneClickAway) {
  const std::string page = page_of(example());
  EXPECT_NE(page.find("<a href=\"figures/jnd.gp\">gp</a>"), std::string::npos);
}

}  // namespace
}  // namespace palpate
