#include "scenes/report/page.h"

#include <gtest/gtest.h>

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
  return make_page(data, origin, tables, {figure}, {{"jnd", "<svg viewBox=\"0 0 1 1\"><g id=\"x\"/></svg>"}});
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

TEST(Page, ShowsTheHardCasesWhenThereAreAny) {
  ReportData data = example();
  EXPECT_EQ(page_of(data).find("Hard cases"), std::string::npos);
  data.hard_cases = Table{"hard_cases", "what holds", false, {{"case", "case"}}, {{std::string("two sites")}}};
  const std::string page = page_of(data);
  EXPECT_NE(page.find("<h2>Hard cases</h2>"), std::string::npos);
  EXPECT_NE(page.find("two sites"), std::string::npos);
}

}  // namespace
}  // namespace palpate
