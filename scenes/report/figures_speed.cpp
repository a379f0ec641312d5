// Speed against error, and what fits cost (figures 2 and 8 of the paper).
#include <algorithm>
#include <cmath>
#include <functional>

#include "scenes/report/figures.h"
#include "scenes/report/tables.h"

namespace palpate {
namespace {

struct Point {
  double x = 0.0;
  double y = 0.0;
  int size = 0;
  bool good = false;  // 99.9 % within the JND
};

using Measure = std::function<double(const ModelResult&)>;

// A method's models by size; the paper's greedy with few candidates stays out.
std::vector<Point> curve(const ReportData& data, const Method& method, const Measure& x, const Measure& y) {
  std::vector<Point> points;
  for (const ModelResult& model : data.models) {
    if (model.plan.request.method != &method || model.plan.request.candidates < 100 || !model.time.measured) continue;
    points.push_back({x(model), y(model), model.size, model.pooled.within_jnd >= kGoodShare});
  }
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.size < b.size; });
  return points;
}

struct Scatter {
  std::string data;
  std::string plots;  // elements of a plot command
  std::vector<SideLabel> labels;
  double rightmost = 0.0;
};

std::string short_count(int count) {
  return count >= 1000 && count % 1000 == 0 ? std::to_string(count / 1000) + "k" : std::to_string(count);
}

Scatter scatter(const ReportData& data, const Measure& x, const Measure& y, const AxisRange& y_axis) {
  Scatter result;
  for (const Method* method : methods()) {
    const std::vector<Point> points = curve(data, *method, x, y);
    if (points.empty()) continue;
    const std::string name(method->name);
    const std::string colour = method_colour(*method);
    std::vector<std::vector<double>> all;
    std::vector<std::vector<double>> good;
    for (const Point& point : points) {
      all.push_back({point.x, point.y});
      if (point.good) good.push_back(all.back());
      result.rightmost = std::max(result.rightmost, point.x);
    }
    result.data += data_block(name, all) + data_block(name + "_good", good);
    const std::string paint = " linecolor rgb \"" + colour + "\"";
    result.plots += (result.plots.empty() ? "plot " : ", \\\n  ") + ("$" + name) + " with lines linewidth 1.5" + paint +
                    ", $" + name + " with points pointtype 7 pointsize 0.75 linecolor rgb \"" + std::string(kPaper) +
                    "\", $" + name + " with points pointtype 6 pointsize 0.75 linewidth 1.5" + paint + ", $" + name +
                    "_good with points pointtype 7 pointsize 0.75" + paint;
    PlannedModel any;
    any.request.method = method;
    std::string label = model_label(any);
    if (points.size() > 1) label += ", " + short_count(points.front().size) + "–" + short_count(points.back().size);
    if (method->can_take(kTakesGrid) && points.size() > 1) label += " nodes";
    result.labels.push_back({y_axis.fraction(points.back().y), label, colour});
  }
  return result;
}

std::vector<double> values(const ReportData& data, const Measure& of) {
  std::vector<double> list;
  for (const ModelResult& model : data.models) list.push_back(of(model));
  return list;
}

const Measure kEvaluation = [](const ModelResult& model) { return model.time.median_ns; };
const Measure kFit = [](const ModelResult& model) { return model.fit_seconds; };
const Measure kRms = [](const ModelResult& model) { return 1e3 * model.pooled.rms_error_N; };
const Measure kWorst = [](const ModelResult& model) { return model.pooled.max_error_over_jnd; };

// Ends at `to`, before the labels of the curves begin.
std::string horizontal(double y, const std::string& text, double to, int tag) {
  const std::string at = std::to_string(y);
  return "set arrow " + std::to_string(tag) + " from graph 0, first " + at + " to first " + std::to_string(to) +
         ", first " + at + " nohead linewidth 1.5 dashtype 2 linecolor rgb \"" + std::string(kMuted) + "\"\nset label " +
         std::to_string(tag) + " " + quoted(text) + " at graph 0.015, first " + at +
         " left offset 0,0.55 noenhanced textcolor rgb \"" + std::string(kMuted) + "\"\n";
}

std::string budget_line() {
  return "set arrow 90 from first 1e6, graph 0 to first 1e6, graph 1 nohead linewidth 1.5 dashtype 2 linecolor rgb \"" +
         std::string(kMuted) + "\"\nset label 90 \"1 ms: one tick\" at first 1e6, graph 0.02 rotate by 90 left "
         "offset -0.8,0 textcolor rgb \"" + std::string(kMuted) + "\"\n";
}

std::string time_tics() {
  std::string text =
      "set xtics (\"10 ns\" 10, \"100 ns\" 100, \"1 µs\" 1e3, \"10 µs\" 1e4, \"100 µs\" 1e5, \"1 ms\" 1e6";
  for (int decade = 1; decade < 6; ++decade) {
    for (int step = 2; step < 10; ++step) text += ", \"\" " + std::to_string(step) + "e" + std::to_string(decade) + " 1";
  }
  return text + ")\n";
}

Figure against_time(const ReportData& data, const std::string& name, const Measure& y, AxisRange axis,
                    const std::string& y_label, double line, const std::string& line_text) {
  Figure figure;
  figure.name = name;
  figure.has_times = true;
  std::vector<double> times = values(data, kEvaluation);
  times.push_back(90.0);  // so that the axis begins with a labelled decade or before it
  const AxisRange time = log_range(times);
  const Scatter plot = scatter(data, kEvaluation, y, axis);
  figure.data = plot.data;
  figure.commands = "set logscale xy\nset xrange [" + std::to_string(time.low) + ":2e6]\nset yrange " + axis.text() +
                    "\n" + axis.tics("y") + time_tics() + "set xlabel \"One evaluation, median\"\nset ylabel \"" + y_label + "\"\n" +
                    horizontal(line, line_text, 1.35 * plot.rightmost, 91) + budget_line() +
                    side_labels(plot.labels, "first " + std::to_string(1.5 * plot.rightmost), 0.075, 1) +
                    plot.plots + "\n";
  return figure;
}

std::vector<double> with(std::vector<double> list, double value) {
  list.push_back(value);
  return list;
}

Figure rms_figure(const ReportData& data) {
  const double jnd_mN = 1e3 * data.jnd.at(0.0);
  Figure figure = against_time(data, "pareto", kRms, log_range(with(values(data, kRms), jnd_mN)), "RMS error [mN]",
                               jnd_mN,
                               "JND at no force, " + three_digits(jnd_mN) + " mN");
  figure.title = "Evaluation time against RMS error";
  figure.caption = "Further left is faster, further down is more accurate. Numbers: fewest and most centres (or grid "
                   "nodes). Filled: at least 99.9 % of the samples within the JND. Everything left "
                   "of the dashed line at 1 ms fits a tick of the loop; below the other one the typical error is less "
                   "than a hand can notice even at the lightest touch.";
  return figure;
}

Figure share_figure(const ReportData& data) {
  double samples = 1.0;
  for (const ModelResult& model : data.models) samples = std::max(samples, static_cast<double>(model.pooled.samples));
  const double floor = 50.0 / samples;  // half a sample, in percent
  const Measure above = [floor](const ModelResult& model) {
    return std::max(floor, 100.0 * (1.0 - model.pooled.within_jnd));
  };
  Figure figure = against_time(data, "pareto_share", above, log_range(with(values(data, above), 0.1)),
                               "Samples above the JND [%]", 0.1, "0.1 %: 99.9 % within the JND");
  figure.title = "Evaluation time against what a hand can notice";
  figure.caption = "The share of the samples in contact with an error that a hand can notice; a model without any "
                   "is drawn at half a sample.";
  return figure;
}

Figure worst_figure(const ReportData& data) {
  Figure figure = against_time(data, "pareto_worst", kWorst, log_range(with(values(data, kWorst), 1.0)),
                               "Worst error [JND]", 1.0, "JND");
  figure.title = "Evaluation time against the worst error";
  figure.caption = "One sample decides: a model whose worst error lies below the line never differs noticeably from "
                   "the measurement. What all models have in common above it is not for another method to mend.";
  return figure;
}

Figure fit_figure(const ReportData& data) {
  Figure figure;
  figure.name = "fit_time";
  figure.title = "Fit time against error";
  figure.caption = "What accuracy costs before the first tick: fits of the same prepared training data, one after the "
                   "other. Filled: at least 99.9 % of the samples within the JND.";
  figure.has_times = true;
  AxisRange y_axis = log_range(values(data, kRms));
  const AxisRange x_axis = log_range(values(data, kFit));
  const Scatter plot = scatter(data, kFit, kRms, y_axis);
  figure.data = plot.data;
  figure.commands = "set logscale xy\nset rmargin 21\nset xrange " + x_axis.text() + "\nset yrange " + y_axis.text() +
                    "\n" + x_axis.tics("x") + y_axis.tics("y") + "set xlabel \"Fit [s]\"\nset ylabel \"RMS error [mN]\"\n" +
                    side_labels(plot.labels, "graph 1.02", 0.075, 1) + plot.plots + "\n";
  return figure;
}

// Costs against something, each curve's name behind its end.
struct CostCurves {
  AxisRange axis;  // logarithmic
  std::string plots;
  std::vector<SideLabel> labels;

  // `what`: a data block, and which of its columns.
  void add(const std::string& what, const std::string& dashes, std::string_view colour, double last_s,
           const std::string& label) {
    plots += (plots.empty() ? "plot $" : ", \\\n  $") + what +
             " with linespoints pointtype 7 pointsize 0.6 linewidth 1.5" + dashes + " linecolor rgb \"" +
             std::string(colour) + "\"";
    labels.push_back({axis.fraction(last_s), label, std::string(colour)});
  }
  std::string commands(const std::string& other_axis, const std::string& label) const {
    return other_axis + "set rmargin 16\nset yrange " + axis.text() + "\n" + axis.tics("y") + "set ylabel \"" +
           label + "\"\n" + side_labels(labels, "graph 1.02", 0.075, 1) + plots + "\n";
  }
};

Figure sites_figure(const ReportData& data) {
  Figure figure;
  figure.name = "fit_time_sites";
  figure.title = "Fit time against training samples (figure 8 of the paper)";
  figure.caption = "Sites are what the reduction keeps. Direct interpolation grows with the cube of their number, the "
                   "methods with 100 centres with the number itself.";
  figure.has_times = true;
  std::vector<std::string> order;
  for (const SitesTime& time : data.sites_time) {
    if (std::find(order.begin(), order.end(), time.method) == order.end()) order.push_back(time.method);
  }
  std::vector<double> seconds;
  double most_sites = 500.0;
  for (const SitesTime& time : data.sites_time) {
    seconds.push_back(time.seconds);
    most_sites = std::max(most_sites, static_cast<double>(time.sites));
  }
  CostCurves curves{log_range(seconds), {}, {}};
  for (std::size_t i = 0; i < order.size(); ++i) {
    std::vector<std::vector<double>> rows;
    for (const SitesTime& time : data.sites_time) {
      if (time.method == order[i]) rows.push_back({static_cast<double>(time.sites), time.seconds});
    }
    const PlannedModel& plan = data.models[i].plan;
    const std::string block = "sites" + std::to_string(i);
    figure.data += data_block(block, rows);
    curves.add(block, plan.request.candidates < 100 ? " dashtype 2" : "", method_colour(*plan.request.method),
               rows.back()[1], model_label(plan));
  }
  figure.commands = curves.commands("set logscale xy\nset xrange [400:" + std::to_string(1.25 * most_sites) +
                                        "]\nset xtics (500, 1000, 2000, 4000, 6850)\nset xlabel \"Sites\"\n",
                                    "Fit [s]");
  return figure;
}

Figure dimension_figure(const ReportData& data) {
  Figure figure;
  figure.name = "cost_dimension";
  figure.title = "Cost against the dimension (figure 2 of the paper)";
  figure.caption = "A grid of 10 nodes a side, filled from the direct interpolant, becomes unaffordable with every "
                   "further feature; centres do not care.";
  figure.has_times = true;
  std::vector<std::vector<double>> rows;
  std::vector<double> seconds;
  for (const DimensionTime& time : data.dimension_time) {
    rows.push_back({static_cast<double>(time.dimension), time.direct_seconds, time.grid_seconds, time.greedy_seconds});
    seconds.insert(seconds.end(), rows.back().begin() + 1, rows.back().end());
  }
  figure.data = data_block("dimension", rows);
  CostCurves curves{log_range(seconds), {}, {}};
  const std::pair<const char*, const Method*> parts[] = {
      {"direct fit", &kDirectMethod}, {"filling the grid", &kVoxelMethod}, {"greedy fit", &kGreedyMethod}};
  for (std::size_t i = 0; i < 3 && !rows.empty(); ++i) {
    curves.add("dimension using 1:" + std::to_string(i + 2), "", method_colour(*parts[i].second), rows.back()[i + 1],
               parts[i].first);
  }
  figure.commands = curves.commands("set logscale y\nset xtics 1\nset xlabel \"Features\"\n", "Seconds");
  return figure;
}

}  // namespace

std::vector<Figure> speed_figures(const ReportData& data) {
  return {rms_figure(data), share_figure(data), worst_figure(data), fit_figure(data)};
}

std::vector<Figure> cost_figures(const ReportData& data) {
  std::vector<Figure> figures;
  if (!data.sites_time.empty()) figures.push_back(sites_figure(data));
  if (!data.dimension_time.empty()) figures.push_back(dimension_figure(data));
  return figures;
}

}  // namespace palpate
