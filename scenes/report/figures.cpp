#include "scenes/report/figures.h"

#include <algorithm>
#include <functional>
#include <map>

#include "engine/base/text.h"

namespace palpate {
namespace {

constexpr double kBudget_s = 1e-3;
constexpr double kNear = 0.2;  // of the budget: from here it is drawn
// Bins with fewer samples say little and are left out of the curves.
constexpr std::uint64_t kFewSamples = 20;

using Kind = std::pair<Recipe, const Method*>;

// The models of one recipe and method, by their size.
std::vector<const ModelResult*> of_kind(const ReportData& data, const Kind& kind) {
  std::vector<const ModelResult*> models;
  for (const ModelResult& one : data.models) {
    if (one.model && one.plan.recipe == kind.first && one.plan.request.method == kind.second) models.push_back(&one);
  }
  std::sort(models.begin(), models.end(), [](auto* a, auto* b) { return a->size < b->size; });
  return models;
}

std::vector<Kind> kinds_of(const ReportData& data) {
  std::vector<Kind> kinds;
  for (const ModelResult& one : data.models) {
    const Kind kind{one.plan.recipe, one.plan.request.method};
    if (one.model && std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
  }
  return kinds;
}

// Every method by its name and colour, once; hollow stands for the recipe of 2009.
void add_legend(Panel& panel, const ReportData& data) {
  for (const Kind& kind : kinds_of(data)) {
    if (kind.first == Recipe::paper) continue;
    PlannedModel plan;
    plan.request.method = kind.second;
    panel.series.push_back({kind.second->label, model_colour(plan), Mark::points, {}});
  }
  panel.series.push_back({"hollow: recipe of 2009", kInkColour, Mark::hollow, {}});
}

using BinFigure = std::function<double(const ForceBin&)>;

Panel force_panel(const ReportData& data, const std::string& title, Recipe recipe, bool over_jnd,
                  const BinFigure& figure) {
  Panel panel;
  panel.title = title;
  panel.x.title = "Measured force [N]";
  panel.y.logarithmic = true;
  panel.y.title = over_jnd ? "Error [JND]" : "Error";
  panel.y.unit = over_jnd ? "" : "N";
  double largest_N = 0.0;
  for (const ModelResult& one : data.models) {
    const bool trend = one.plan.recipe == Recipe::trend && recipe == Recipe::palpate;
    if (!one.model || !one.plan.main || (one.plan.recipe != recipe && !trend)) continue;
    Series series{"", model_colour(one.plan), recipe == Recipe::paper ? Mark::hollow_curve : Mark::curve, {}};
    for (const ForceBin& bin : one.errors.bins) {
      if (bin.count < kFewSamples) continue;
      series.rows.push_back({bin.mean_force_N, figure(bin)});
      largest_N = std::max(largest_N, bin.mean_force_N);
    }
    panel.series.push_back(std::move(series));
  }
  if (over_jnd) {
    panel.levels.push_back({1.0, "1 JND"});
  } else {
    panel.series.push_back(
        {"", kMutedColour, Mark::dashed, {{0.0, data.jnd.at(0.0)}, {largest_N, data.jnd.at(largest_N)}}});
  }
  return panel;
}

// The same scale for both recipes, side by side.
void share_scale(Panel& one, Panel& other) {
  double low = 1e300;
  double high = 0.0;
  const auto include = [&](double value) {
    if (value > 0.0) low = std::min(low, value);
    high = std::max(high, value);
  };
  for (const Panel* panel : {&one, &other}) {
    for (const Series& series : panel->series) {
      for (const PlotRow& row : series.rows) include(row.y);
    }
    for (const Level& level : panel->levels) include(level.value);
  }
  if (!(low < high)) return;
  one.y.low = other.y.low = low / 1.3;
  one.y.high = other.y.high = high * 1.3;
}

Panel jnd_panel(const ReportData& data, double largest_N) {
  Panel panel;
  panel.title = "3  the JND that errors are judged by";
  panel.x.title = "Force [N]";
  panel.y = {"JND", "N", true};
  Series line{"", kInkColour, Mark::line, {}};
  for (int i = 0; i <= 50; ++i) line.rows.push_back({largest_N * i / 50.0, data.jnd.at(largest_N * i / 50.0)});
  panel.series.push_back(std::move(line));
  return panel;
}

Panel fit_time_panel(const ReportData& data) {
  Panel panel;
  panel.title = "8  time of a fit";
  panel.x = {"Centres, or nodes of the grid", "", true};
  panel.y = {"Time", "s", true};
  for (const Kind& kind : kinds_of(data)) {
    if (kind.first == Recipe::trend) continue;
    Series series;
    for (const ModelResult* one : of_kind(data, kind)) {
      series.colour = model_colour(one->plan);
      series.rows.push_back({static_cast<double>(one->size), one->fit_seconds});
    }
    series.mark = kind.first == Recipe::paper ? Mark::hollow_curve : Mark::curve;
    panel.series.push_back(std::move(series));
  }
  return panel;
}

}  // namespace

Hue model_colour(const PlannedModel& plan) {
  return plan.recipe == Recipe::nothing ? kMutedColour : plan.request.method->colour;
}

Figure speed_figure(const ReportData& data) {
  Figure figure;
  Panel panel;
  panel.x = {"Time of a whole tick, log", "s", true};
  panel.y = {"99 % of the errors are below [JND], log", "", true};
  add_legend(panel, data);
  double slowest_s = 0.0;
  double least = 1e300;
  for (const Kind& kind : kinds_of(data)) {
    const bool hollow = kind.first == Recipe::paper;
    Series curve{"", kInkColour, hollow ? Mark::hollow_curve : Mark::curve, {}};
    for (const ModelResult* one : of_kind(data, kind)) {
      if (!one->time.measured) continue;
      const double tick_s = 1e-9 * one->time.tick.median_ns;
      const double error = one->errors.p99_error_over_jnd;
      slowest_s = std::max(slowest_s, tick_s);
      least = error > 0.0 ? std::min(least, error) : least;
      curve.colour = model_colour(one->plan);
      curve.rows.push_back({tick_s, error});
      if (!one->plan.main) continue;
      const Interval interval = one->errors.p99_interval();
      panel.series.push_back({"", curve.colour, Mark::plus, {{1e-9 * one->time.evaluation.median_ns, error}}});
      panel.series.push_back(
          {"", curve.colour, hollow ? Mark::hollow : Mark::bars, {{tick_s, error, interval.low, interval.high}}});
    }
    panel.series.push_back(std::move(curve));
  }
  panel.levels.push_back({1.0, "1 JND"});
  if (data.floor.p99_error_over_jnd > 0.3 * least) panel.levels.push_back({data.floor.p99_error_over_jnd, "noise"});
  if (slowest_s > kNear * kBudget_s) {
    panel.levels.push_back({kBudget_s, "budget 1 ms", true});
  } else {
    panel.x.title += " (the budget, 1 ms, is off to the right)";
  }
  figure.plot.name = "speed_error";
  figure.plot.width = 0.75;
  figure.plot.height = 1.9;
  figure.plot.panels = {std::move(panel)};
  figure.caption =
      "Down is better, left is faster; below 1 JND a hand notices nothing; noise: of the force sensor. A curve: one "
      "method "
      "with more and more centres. Bars: 95 % by strokes, of 100 "
      "centres; models that are tied are told by their paired difference in the table, not by bars. +: the "
      "bare evaluation, without motion estimate and features.";
  return figure;
}

Figure worst_figure(const ReportData& data) {
  Figure figure;
  const WorstStretch& worst = data.worst;
  Panel force;
  force.title = worst.recording;
  force.y.title = "Force [N]";
  Panel difference;
  difference.x.title = "Time [s]";
  difference.y.title = "Difference [JND]";
  Series band{"within 1 JND", kMutedColour, Mark::area, {}};
  Series measured{"measured", kMeasuredColour, Mark::line, {}};
  std::vector<Series> said;
  std::vector<Series> differs;
  for (const std::size_t index : worst.models) {
    const PlannedModel& plan = data.models[index].plan;
    said.push_back({plan.name, model_colour(plan), plan.recipe == Recipe::paper ? Mark::dashed : Mark::line, {}});
    differs.push_back(said.back());
  }
  double largest = 1.2;
  for (const StretchRow& row : worst.rows) {
    measured.rows.push_back({row.time_s, row.measured_N});
    band.rows.push_back({row.time_s, 0.0, -1.0, 1.0});
    for (std::size_t i = 0; i < said.size(); ++i) {
      const double over = (row.force_N[i] - row.measured_N) / data.jnd.at(row.measured_N);
      said[i].rows.push_back({row.time_s, row.force_N[i]});
      differs[i].rows.push_back({row.time_s, row.in_contact ? over : kNoValue});
      if (i == 0 && row.in_contact) largest = std::max(largest, std::abs(over));
    }
  }
  // The chosen model decides the scale; what another does beyond it is cut.
  difference.y.low = -1.5 * largest;
  difference.y.high = 1.5 * largest;
  force.series = {std::move(measured)};
  difference.series = {std::move(band)};
  // The chosen one on top.
  for (std::size_t i = said.size(); i-- > 0;) {
    force.series.push_back(std::move(said[i]));
    difference.series.push_back(std::move(differs[i]));
  }
  if (!worst.rows.empty()) {
    for (Panel* panel : {&force, &difference}) {
      panel->x.low = worst.rows.front().time_s;
      panel->x.high = worst.rows.back().time_s;
    }
  }
  figure.plot.name = "worst_stretch";
  figure.plot.panels = {std::move(force), std::move(difference)};
  figure.plot.height = 0.8;
  figure.caption =
      "The worst " + three_digits(worst.rows.empty() ? 0.0 : worst.rows.back().time_s - worst.rows.front().time_s) +
      " s of " + data.models[data.choice.chosen].plan.name + " (largest mean squared error over the JND): RMS " +
      three_digits(std::sqrt(std::max(0.0, worst.score))) +
      " JND. Below: model less measurement; grey is what a hand cannot notice.";
  return figure;
}

Figure paper_figure(const ReportData& data) {
  struct Row {
    const char* title;
    bool over_jnd;
    BinFigure figure;
  };
  const std::vector<Row> rows{
      {"4  mean + deviation", false, [](const ForceBin& bin) { return bin.mean_abs_error_N + bin.std_abs_error_N; }},
      {"5  the same over the JND", true,
       [](const ForceBin& bin) { return bin.mean_error_over_jnd + bin.std_error_over_jnd; }},
      {"6  maximum", false, [](const ForceBin& bin) { return bin.max_abs_error_N; }},
      {"7  the same over the JND", true, [](const ForceBin& bin) { return bin.max_error_over_jnd; }}};
  Figure figure;
  for (const Row& row : rows) {
    Panel paper =
        force_panel(data, std::string(row.title) + ", recipe of 2009", Recipe::paper, row.over_jnd, row.figure);
    Panel palpate = force_panel(data, std::string(row.title) + ", Palpate", Recipe::palpate, row.over_jnd, row.figure);
    share_scale(paper, palpate);
    figure.plot.panels.push_back(std::move(paper));
    figure.plot.panels.push_back(std::move(palpate));
  }
  double largest_N = 1.0;
  for (const RecordingFacts& facts : data.recordings) largest_N = std::max(largest_N, facts.largest_force_N);
  figure.plot.panels.push_back(jnd_panel(data, largest_N));
  figure.plot.panels.push_back(fit_time_panel(data));
  add_legend(figure.plot.panels.front(), data);
  figure.plot.panels.front().series.push_back({"JND", kMutedColour, Mark::dashed, {}});
  figure.plot.name = "paper";
  figure.plot.columns = 2;
  figure.plot.height = 0.85;
  figure.caption =
      "Figures 3 to 8 of Hoever & Harders (2009) on these recordings, 100 centres. Where they depart from the paper's "
      "own: "
      "5 and 7 are over the JND here and over the force there; 4 to 7 are against force in bins two JND wide, without "
      "bins of "
      "fewer than 20 samples; 8 is over the number of centres here and over that of samples there. Figure 2 (cost over "
      "the dimension) and figure 8 as it was are in build/palpate-bench.";
  return figure;
}

}  // namespace palpate
