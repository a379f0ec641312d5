#include "scenes/plot/plot.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/base/files.h"
#include "tests/support/message_parts.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

// Errors of two methods up to `largest_N`, as in the report.
Plot errors_up_to(double largest_N) {
  Plot plot;
  plot.name = "errors";
  plot.columns = 2;
  for (const bool over_jnd : {false, true}) {
    Panel panel;
    panel.title = "maximum";
    panel.x.title = "Measured force [N]";
    panel.y = {over_jnd ? "Error [JND]" : "Error", over_jnd ? "" : "N", true};
    for (const char* name : {"greedy", "random"}) {
      Series series{name, 0xD55E00, Mark::curve, {}};
      for (int i = 1; i <= 10; ++i)
        series.rows.push_back({largest_N * i / 10.0, (over_jnd ? 0.1 : 0.02 * largest_N) * i});
      panel.series.push_back(std::move(series));
    }
    if (over_jnd) panel.levels.push_back({1.0, "1 JND"});
    plot.panels.push_back(std::move(panel));
  }
  return plot;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// For any range of forces all method names and both axis titles are shown, and tics have only
// a few digits.
TEST(Plot, HoldsFromThreeTenthsOfANewtonToThreeKilonewtons) {
  if (!find_gnuplot()) GTEST_SKIP() << "no gnuplot here";
  for (const auto& [largest_N, tic] : {std::pair{0.3, "10 mN"}, std::pair{30.0, "1 N"}, std::pair{3000.0, "100 N"}}) {
    const test::TemporaryFolder folder;
    const Status drawn = draw_plots(folder.path(), {errors_up_to(largest_N)});
    ASSERT_TRUE(drawn.ok()) << drawn.error().message;
    const std::string svg = *read_whole_file(folder.file("errors.svg"));
    for (const char* text : {"greedy", "random", "Measured force [N]", "Error", "Error [JND]", "1 JND"}) {
      EXPECT_TRUE(test::has_parts(svg, {text})) << text << " at " << largest_N;
    }
    EXPECT_EQ(count_of(svg, "greedy"), 1u) << "once for all panels";
    EXPECT_TRUE(test::has_parts(svg, {tic})) << largest_N;
    EXPECT_EQ(svg.find("00000"), std::string::npos) << largest_N;
    EXPECT_TRUE(read_whole_file(folder.file("errors.png")).has_value());
  }
}

TEST(Layout, ANameStandsAtItsPointBetweenTheBars) {
  Panel panel;
  panel.names_at_ends = true;
  panel.x = {"", "", false, 0.0, 10.0};
  panel.y = {"", "", false, 0.0, 1.0};
  panel.series = {{"left", 0, Mark::bars, {{2.0, 0.2, 0.1, 0.3, 1.0, 5.0}}},
                  {"at the edge", 0, Mark::bars, {{9.5, 0.99, 0.7, 0.9, 7.5, 9.9}}}};
  const std::vector<NameTag> tags = name_tags(panel, 0.1, 0.01);
  ASSERT_EQ(tags.size(), 2u);
  EXPECT_TRUE(tags[0].begins_here);
  EXPECT_DOUBLE_EQ(tags[0].x, 0.2);
  EXPECT_DOUBLE_EQ(tags[0].y, 0.37) << "above the bar";
  EXPECT_FALSE(tags[1].begins_here);
  EXPECT_DOUBLE_EQ(tags[1].x, 0.95);
  EXPECT_DOUBLE_EQ(tags[1].y, 0.92);
}

TEST(Plot, NamesAreTextAndNoCommands) {
  Plot plot = errors_up_to(1.0);
  plot.panels[0].title = "a\"; system('touch hit') #`x`\\";
  EXPECT_NE(test::must(plot_script(plot)).find("set title \"a'; system('touch hit') #'x''\""), std::string::npos);
}

TEST(Gnuplot, AnErrorNamesTheScript) {
  if (!find_gnuplot()) GTEST_SKIP() << "no gnuplot here";
  const test::TemporaryFolder folder;
  Plot plot = errors_up_to(1.0);
  plot.name = "a'";  // ends the name of the output
  EXPECT_TRUE(test::has_parts(draw_plots(folder.path(), {plot}), {"a'.gp", "; "}));
}

TEST(Gnuplot, IsCheckedBeforeAnyWork) {
  const test::TemporaryFolder folder;
  const auto ran = test::run_palpate({"report", "--quick", "--out", folder.file("report")}, {"PATH=" + folder.path()});
  EXPECT_EQ(ran.exit_code, 1);
  EXPECT_TRUE(test::has_parts(ran.err, {"error: ", "PATH", "apt-get install gnuplot-nox"}));
  EXPECT_TRUE(folder.entries().empty());
}

TEST(DrawPlot, WritesOneFileWholeOrNothing) {
  if (!find_gnuplot()) GTEST_SKIP() << "no gnuplot here";
  const test::TemporaryFolder folder;
  EXPECT_TRUE(
      test::has_parts(draw_plot(errors_up_to(3.0), folder.file("a.jpg"), false), {"--plot", folder.file("a.jpg")}));
  ASSERT_TRUE(draw_plot(errors_up_to(3.0), folder.file("a.svg"), false).ok());
  EXPECT_EQ(folder.entries(), (std::vector<std::string>{"a.svg"}));
  EXPECT_FALSE(draw_plot(errors_up_to(3.0), folder.file("a.svg"), false).ok()) << "it exists";
}

}  // namespace
}  // namespace palpate
