#include "scenes/report/figures/figure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenes/report/figures/figures.h"

namespace palpate {
namespace {

TEST(SpreadLabels, NeverOverlapStayInsideAndKeepTheirOrder) {
  const std::vector<double> at = spread_labels({0.99, 0.98, 0.97, 0.5, 0.5, 0.0}, 0.07);
  ASSERT_EQ(at.size(), 6u);
  std::vector<double> sorted = at;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) EXPECT_GE(sorted[i] - sorted[i - 1], 0.07 - 1e-6);
  EXPECT_LE(sorted.back(), 0.98 + 1e-9);
  EXPECT_GE(sorted.front(), 0.0);
  EXPECT_EQ(at.front(), sorted.back()) << "the highest stays the highest";
}

TEST(FittedSlope, IsThatOfAPowerLaw) {
  const FittedSlope exact = fitted_slope({1.0, 2.0, 4.0, 8.0}, {3.0, 3.0 * std::pow(2.0, 1.5), 3.0 * std::pow(4.0, 1.5), 3.0 * std::pow(8.0, 1.5)});
  EXPECT_NEAR(exact.slope, 1.5, 1e-12);
  EXPECT_NEAR(exact.half_width, 0.0, 1e-6);
  EXPECT_FALSE(std::isfinite(fitted_slope({1.0, 2.0}, {1.0, 2.0}).slope)) << "two points decide nothing";
}

TEST(AxisRange, EndsAtRoundNumbersBeyondTheData) {
  const AxisRange range = log_range({8.9, 15.0, 65.0});
  EXPECT_DOUBLE_EQ(range.low, 5.0);
  EXPECT_DOUBLE_EQ(range.high, 100.0);
  EXPECT_NEAR(range.fraction(5.0), 0.0, 1e-12);
  EXPECT_NEAR(range.fraction(100.0), 1.0, 1e-12);
  EXPECT_NEAR(range.value(range.fraction(20.0)), 20.0, 1e-9);
  EXPECT_EQ(range.tics("y"), "set ytics (\"5\" 5, \"\" 6 1, \"\" 7 1, \"\" 8 1, \"\" 9 1, \"10\" 10, \"20\" 20, \"\" 30 1, "
                             "\"\" 40 1, \"50\" 50, \"\" 60 1, \"\" 70 1, \"\" 80 1, \"\" 90 1, \"100\" 100)\n");
  EXPECT_GE(zero_range({6.03}).high, 6.03);
  EXPECT_EQ(zero_range({}).high, 1.0);
}

TEST(InlineSvg, FollowsThePageAndHasItsOwnIds) {
  const std::string svg = inline_svg(
      "<?xml version=\"1.0\"?>\n<svg \n width=\"600\" height=\"400\"\n viewBox=\"0 0 600 400\"\n "
      "xmlns=\"http://www.w3.org/2000/svg\"\n>\n<title>Gnuplot</title>\n<desc>Produced by GNUPLOT 5.4 </desc>\n"
      "<g id=\"g\"><path id='p' stroke='rgb( 34,  34,  34)' fill=\"rgb(216,216,216)\"/>"
      "<use xlink:href='#p' color=\"#FEFEFE\"/></g></svg>",
      "name", "A & B");
  EXPECT_EQ(svg, "<svg viewBox=\"0 0 600 400\" role=\"img\" aria-label=\"A &amp; B\">\n\n<g id=\"name-g\"><path "
                 "id='name-p' stroke='var(--ink)' fill=\"var(--grid)\"/><use href='#name-p' color=\"var(--paper)\"/>"
                 "</g></svg>");
}

TEST(Figures, QuoteWhatComesFromOutside) {
  EXPECT_EQ(quoted("a\"b\\c`d"), "\"a'b'c'd\"");
}

}  // namespace
}  // namespace palpate
