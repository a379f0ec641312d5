// What fits cost (figures 8 and 2 of the paper).
#include <algorithm>
#include <array>
#include <cmath>

#include "scenes/report/figures/figures.h"

namespace palpate {
namespace {

// Student's t, two-sided 95 %, by degrees of freedom from 1.
constexpr std::array<double, 6> kStudent{12.71, 4.303, 3.182, 2.776, 2.571, 2.447};

std::string slope_text(const FittedSlope& fit) {
  return fixed(fit.slope, 2) + " ± " + fixed(fit.half_width, 2);
}

struct Line {
  std::string label;
  double colour = 0.0;
  std::vector<double> x;
  std::vector<double> y;
};

void add_lines(Figure& figure, const std::vector<Line>& lines) {
  std::vector<double> heights;
  for (const Line& line : lines) heights.insert(heights.end(), line.y.begin(), line.y.end());
  const AxisRange axis = log_range(heights);
  Table table{figure.name, "", true, {{"line", ""}, {"x", ""}, {"seconds", ""}, {"colour", ""}}, {}};
  Table labels{figure.name + "_labels", "", true, {{"x", ""}, {"seconds", ""}, {"colour", ""}, {"label", ""}}, {}};
  std::vector<double> wanted;
  for (const Line& line : lines) wanted.push_back(line.y.empty() ? 0.5 : axis.fraction(line.y.back()));
  const std::vector<double> at = spread_labels(wanted, 0.075);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t k = 0; k < lines[i].x.size(); ++k) {
      table.rows.push_back({lines[i].label, lines[i].x[k], lines[i].y[k], lines[i].colour});
    }
    table.rows.push_back({});
    if (!lines[i].x.empty()) {
      labels.rows.push_back({lines[i].x.back(), axis.value(at[i]), lines[i].colour, lines[i].label});
    }
  }
  figure.data = {std::move(table), std::move(labels)};
  figure.set_number("y_low", axis.low);
  figure.set_number("y_high", axis.high);
  figure.settings += axis.tics("y");
  figure.width = 760;
  figure.height = 330;
  figure.script = "cost";
}

Figure sites_figure(const ReportData& data) {
  Figure figure;
  figure.name = "fit_time_sites";
  figure.title = "Fit time against training samples (figure 8 of the paper)";
  figure.has_times = true;
  std::vector<Line> lines;
  for (const SitesTime& time : data.sites_time) {
    const auto model = std::find_if(data.models.begin(), data.models.end(),
                                    [&](const ModelResult& one) { return one.plan.name == time.model; });
    const std::string label = model != data.models.end() ? model_label(model->plan) : time.model;
    auto line = std::find_if(lines.begin(), lines.end(), [&](const Line& one) { return one.label == label; });
    if (line == lines.end()) {
      lines.push_back({label, model != data.models.end() ? model_colour(model->plan) : 0.0, {}, {}});
      line = lines.end() - 1;
    }
    line->x.push_back(static_cast<double>(time.sites));
    line->y.push_back(time.seconds);
  }
  figure.caption = "Sites are what the reduction keeps. ";
  std::string slopes;
  for (const Line& line : lines) {
    const FittedSlope slope = fitted_slope(line.x, line.y);
    if (std::isfinite(slope.slope)) slopes += (slopes.empty() ? "" : ", ") + line.label + " " + slope_text(slope);
  }
  figure.caption += slopes.empty() ? "Too few sites for a slope to be fitted."
                                   : "Fitted exponents of their number, with 95 % intervals: " + slopes + ".";
  add_lines(figure, lines);
  figure.set_text("x_label", "Sites");
  figure.set_number("x_log", 1.0);
  std::string tics;
  for (const double x : lines.empty() ? std::vector<double>{} : lines.front().x) tics += (tics.empty() ? "" : ", ") + fixed(x, 0);
  figure.settings += "set xtics (" + tics + ")\n";
  return figure;
}

Figure dimension_figure(const ReportData& data) {
  Figure figure;
  figure.name = "cost_dimension";
  figure.title = "Cost against the dimension (figure 2 of the paper)";
  figure.has_times = true;
  std::vector<Line> lines{{"direct fit", 0x000001, {}, {}},
                          {"filling the grid", static_cast<double>(kVoxelMethod.colour), {}, {}},
                          {"greedy fit", static_cast<double>(kGreedyMethod.colour), {}, {}}};
  for (const DimensionTime& time : data.dimension_time) {
    const double seconds[] = {time.direct_seconds, time.grid_seconds, time.greedy_seconds};
    for (std::size_t i = 0; i < lines.size(); ++i) {
      lines[i].x.push_back(time.dimension);
      lines[i].y.push_back(seconds[i]);
    }
  }
  const DimensionTime& last = data.dimension_time.back();
  figure.caption = "A grid of 10 nodes a side, filled from the direct interpolant of " +
                   std::to_string(data.dimension_sites) + " sites: " + three_digits(last.grid_seconds) + " s with " +
                   std::to_string(last.dimension) + " features, where the direct fit takes " +
                   three_digits(last.direct_seconds) + " s and the greedy one " + three_digits(last.greedy_seconds) + " s.";
  add_lines(figure, lines);
  figure.set_text("x_label", "Features");
  figure.set_number("x_log", 0.0);
  return figure;
}

}  // namespace

FittedSlope fitted_slope(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  if (n < 3) return {kNoNumber, kNoNumber};
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    mean_x += std::log(x[i]) / static_cast<double>(n);
    mean_y += std::log(y[i]) / static_cast<double>(n);
  }
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    xx += (std::log(x[i]) - mean_x) * (std::log(x[i]) - mean_x);
    xy += (std::log(x[i]) - mean_x) * (std::log(y[i]) - mean_y);
  }
  const double slope = xy / xx;
  double squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double residual = std::log(y[i]) - mean_y - slope * (std::log(x[i]) - mean_x);
    squares += residual * residual;
  }
  const double student = kStudent[std::min(n - 3, kStudent.size() - 1)];
  return {slope, student * std::sqrt(squares / static_cast<double>(n - 2) / xx)};
}

std::vector<Figure> cost_figures(const ReportData& data) {
  std::vector<Figure> figures;
  if (!data.sites_time.empty()) figures.push_back(sites_figure(data));
  if (!data.dimension_time.empty()) figures.push_back(dimension_figure(data));
  return figures;
}

}  // namespace palpate
