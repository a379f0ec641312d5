#include "scenes/report/table.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/message_parts.h"

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

TEST(Table, HtmlShowsUnitsEscapesTextAndAlignsNumbers) {
  const std::string html = table_html(example());
  EXPECT_TRUE(test::has_parts(html, {"<th class=\"text\">model</th><th>count</th><th>RMS [mN]</th>",
                                     "<td class=\"text\">a,&quot;b&quot;</td><td>12,345</td><td>100</td><td>99.95</td>",
                                     "&lt;i&gt;</td><td>0</td><td>–</td><td>100.00</td>"}));
}

TEST(Table, TextIsThatOfThePageWithoutMarks) {
  EXPECT_EQ(table_text(example()), (std::vector<std::vector<std::string>>{{"model", "count", "RMS [mN]", "share [%]"},
                                                                          {"a,\"b\"", "12,345", "100", "99.95"},
                                                                          {"<i>", "0", "–", "100.00"}}));
}

TEST(Table, AnIntervalStandsUnderItsFigureAndInTheFileBesideIt) {
  const Table table{"example",
                    false,
                    {{"share", "share [%]", 100.0, 1, 2}, {"share_low", "", 100.0, 1}, {"share_high", "", 100.0, 1}},
                    {{0.5, 0.25, 0.75}}};
  EXPECT_EQ(table_csv(table), "share,share_low,share_high\n0.5,0.25,0.75\n");
  EXPECT_TRUE(test::has_parts(table_html(table), {"<td>50.0<small>25.0–75.0</small></td></tr>"}));
}

TEST(Table, ATruthValueIsAWordOnThePage) {
  const Table table{"example", false, {{"expected", "as expected"}}, {{true}, {false}}};
  EXPECT_EQ(table_csv(table), "expected\ntrue\nfalse\n");
  EXPECT_EQ(table_json(table).dump(), "[{\"expected\":true},{\"expected\":false}]");
  EXPECT_EQ(table_text(table), (std::vector<std::vector<std::string>>{{"as expected"}, {"yes"}, {"no"}}));
}

TEST(Table, ARowWithoutCellsBreaksALine) {
  EXPECT_EQ(table_csv({"t", false, {{"x", ""}}, {{1.0}, {}, {2.0}}}), "x\n1\n\n2\n");
}

}  // namespace
}  // namespace palpate
