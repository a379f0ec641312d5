#include "scenes/report/figures.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/text.h"
#include "scenes/plot/layout.h"

namespace palpate {
namespace {

constexpr double kBudget_s = 1e-3;
constexpr double kNear = 0.2;  // the budget is drawn if a tick takes more than this share of it
// The curves omit bins with fewer samples.
constexpr std::uint64_t kFewSamples = 20;

// The colour of the model's method, which the window uses as well; grey for no force.
Hue model_colour(const ModelResult& model) { return model.plan ? Hue(colour_of(*model.plan)) : kMutedColour; }

// The models of each family, in order of their size.
std::vector<std::vector<const ModelResult*>> kinds_of(const ReportData& data) {
  std::vector<std::vector<const ModelResult*>> kinds;
  for (const ModelResult& one : data.models) {
    if (!one.model) continue;
    const auto is_same = [&](const std::vector<const ModelResult*>& kind) {
      return family_name(*kind.front()->plan) == family_name(*one.plan);
    };
    auto kind = std::ranges::find_if(kinds, is_same);
    if (kind == kinds.end()) kind = kinds.emplace(kinds.end());
    kind->push_back(&one);
  }
  for (auto& kind : kinds) std::ranges::sort(kind, {}, &ModelResult::size);
  return kinds;
}

using BinFigure = double (*)(const ForceBin&);

// Error against force of the methods of one recipe; the panel of this program's recipe includes the trend.
Panel force_panel(const ReportData& data, const std::string& title, Base base, BinFigure figure) {
  Panel panel;
  panel.title = title + (base == Base::force ? ", on the force" : ", on the trend");
  panel.x.title = "Measured force [N]";
  panel.y = {"Error [JND]", "", true};
  panel.names_at_ends = true;
  panel.levels.push_back({1.0, "1 JND"});
  for (const std::size_t i : data.choice.candidates) {
    const ModelResult& one = data.models[i];
    if (!one.plan || one.plan->base != base) continue;
    Series series{
        one.plan->method->label, model_colour(one), base == Base::force ? Mark::hollow_curve : Mark::curve, {}};
    for (const ForceBin& bin : one.errors.bins) {
      if (bin.force_N.count() >= kFewSamples) series.rows.push_back({bin.force_N.mean(), figure(bin)});
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

// Gives the panels of both recipes the same scale, because they are side by side.
void share_scale(Panel& one, Panel& other) {
  const AxisRange first = range_of(one, true);
  const AxisRange second = range_of(other, true);
  one.y.low = other.y.low = std::min(first.low, second.low);
  one.y.high = other.y.high = std::max(first.high, second.high);
}

}  // namespace

Figure speed_figure(const ReportData& data) {
  Figure figure;
  Panel panel;
  panel.x = {"Time of a whole tick, log", "s", true};
  panel.y = {"99 % of the errors are below [JND], log", "", true};
  panel.names_at_ends = true;
  double slowest_s = 0.0;
  double least = 1e300;
  for (const auto& kind : kinds_of(data)) {
    Series curve{"", kInkColour, Mark::line, {}};
    for (const ModelResult* one : kind) {
      if (!one->time.measured) continue;
      slowest_s = std::max(slowest_s, 1e-9 * one->time.tick.high_ns);
      least = std::min(least, std::max(one->errors.p99_error_over_jnd, 1e-6));
      curve.colour = model_colour(*one);
      curve.rows.push_back({1e-9 * one->time.tick.median_ns, one->errors.p99_error_over_jnd});
    }
    if (curve.rows.size() > 1) panel.series.push_back(std::move(curve));
  }
  for (const std::size_t i : headline_models(data)) {
    const ModelResult& one = data.models[i];
    if (!one.time.measured) continue;
    const Interval interval = one.errors.p99_interval();
    const Timing& tick = one.time.tick;
    panel.series.push_back({one.name,
                            model_colour(one),
                            one.plan && one.plan->base == Base::force ? Mark::hollow_bars : Mark::bars,
                            {{1e-9 * tick.median_ns, one.errors.p99_error_over_jnd, interval.low, interval.high,
                              1e-9 * tick.low_ns, 1e-9 * tick.high_ns}}});
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
      "Lower is more accurate, further left is faster; a hand does not notice errors below 1 JND; noise: that of the "
      "force sensor. Dots: the models of the table; hollow: the recipe of 2009. Bars: six rounds of timing, and the "
      "95 % interval of the error where there is one; models are compared by their paired differences. Lines: one "
      "method with increasing numbers of centres.";
  return figure;
}

Figure worst_figure(const ReportData& data) {
  Figure figure;
  const WorstStretch& worst = data.worst;
  Panel force;
  Panel difference;
  force.title = worst.recording;
  force.names_at_ends = difference.names_at_ends = true;
  force.y.title = "Force [N]";
  difference.x.title = "Time [s]";
  difference.y.title = "Difference [JND]";
  force.series = {{"measured", kMeasuredColour, Mark::line, {}}};
  difference.series = {{"within 1 JND", kMutedColour, Mark::area, {}}};
  // The recommended model, the first one, is drawn last, on top of the others.
  for (std::size_t i = worst.models.size(); i-- > 0;) {
    const ModelResult& model = data.models[worst.models[i]];
    const Mark mark = model.plan->base == Base::force ? Mark::dashed : Mark::line;
    for (Panel* panel : {&force, &difference}) panel->series.push_back({model.name, model_colour(model), mark, {}});
  }
  double largest = 1.2;
  for (const StretchRow& row : worst.rows) {
    force.series[0].rows.push_back({row.time_s, row.measured_N});
    difference.series[0].rows.push_back({row.time_s, 0.0, -1.0, 1.0});
    for (std::size_t i = 0; i < worst.models.size(); ++i) {
      const double over = (row.force_N[i] - row.measured_N) / data.scene.jnd.at(row.measured_N);
      const std::size_t drawn = worst.models.size() - i;
      force.series[drawn].rows.push_back({row.time_s, row.force_N[i]});
      difference.series[drawn].rows.push_back({row.time_s, row.in_contact ? over : kNoValue});
      if (i == 0 && row.in_contact) largest = std::max(largest, std::abs(over));
    }
  }
  // The recommended model determines the scale. Larger differences of other models are cut and marked.
  difference.y.low = -1.5 * largest;
  difference.y.high = 1.5 * largest;
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
      " s of " + data.models[data.choice.recommended].name + " (largest mean squared error over the JND): RMS " +
      three_digits(std::sqrt(std::max(0.0, worst.score))) +
      " JND. Below: model minus measurement; grey: differences that a hand cannot notice.";
  return figure;
}

Figure force_figure(const ReportData& data) {
  const std::pair<const char*, BinFigure> rows[] = {
      {"Mean + deviation", [](const ForceBin& bin) { return bin.over_jnd.mean() + bin.over_jnd.deviation(); }},
      {"Maximum", [](const ForceBin& bin) { return bin.over_jnd.largest(); }}};
  Figure figure;
  for (const auto& [title, value] : rows) {
    Panel paper = force_panel(data, title, Base::force, value);
    Panel palpate = force_panel(data, title, Base::trend, value);
    share_scale(paper, palpate);
    figure.plot.panels.push_back(std::move(paper));
    figure.plot.panels.push_back(std::move(palpate));
  }
  figure.plot.name = "error_by_force";
  figure.plot.columns = 2;
  figure.caption =
      "Error divided by the JND against force, 100 centres, in bins two JND wide with at least 20 samples. Figures 5 "
      "and 7 of Hoever & Harders (2009) show the error divided by the force (drawn by palpate paper).";
  return figure;
}

}  // namespace palpate
