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

Mark mark_of(const ModelResult& model, Mark on_force, Mark on_trend) {
  return model.plan && model.plan->base == Base::force ? on_force : on_trend;
}

using BinFigure = double (*)(const ForceBin&);

// Error against force of the headline models with this base and 100 centres.
Panel force_panel(const ReportData& data, const std::string& title, Base base, BinFigure figure) {
  Panel panel;
  panel.title = title + (base == Base::force ? ", on the force" : ", on the trend");
  panel.x.title = "Measured force [N]";
  panel.y = {"Error [JND]", "", true};
  panel.names_at_ends = true;
  panel.levels.push_back({1.0, "1 JND"});
  for (const std::size_t i : headline_models(data)) {
    const ModelResult& one = data.models[i];
    if (!one.plan || one.plan->base != base || one.selects_size) continue;
    Series series{one.name, model_colour(one), mark_of(one, Mark::hollow_curve, Mark::curve), {}};
    for (const ForceBin& bin : one.errors.bins) {
      if (bin.force_N.count() >= kFewSamples) series.rows.push_back({bin.force_N.mean(), figure(bin)});
    }
    panel.series.push_back(std::move(series));
  }
  return panel;
}

// The bins that the curves omit; all models have the same samples.
std::string omitted_bins(const ReportData& data) {
  std::size_t bins = 0, omitted = 0;
  std::uint64_t samples = 0;
  for (const ForceBin& bin : data.models.front().errors.bins) {
    const std::uint64_t count = bin.force_N.count();
    bins += count > 0 ? 1 : 0;
    if (count == 0 || count >= kFewSamples) continue;
    ++omitted;
    samples += count;
  }
  return std::to_string(omitted) + " of " + std::to_string(bins) + " bins have fewer than " +
         std::to_string(kFewSamples) + " samples, " + std::to_string(samples) + " in all, and are not drawn";
}

// Gives both panels the same scale, because they are side by side.
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
  const std::vector<std::size_t> shown = headline_models(data);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const ModelResult& one = data.models[shown[k]];
    if (!one.time.measured) continue;
    const Interval interval = one.errors.p99_interval();
    const Timing& tick = one.time.tick;
    slowest_s = std::max(slowest_s, 1e-9 * tick.high_ns);
    least = std::min(least, std::max(one.errors.p99_error_over_jnd, 1e-6));
    const PlotRow point{1e-9 * tick.median_ns, one.errors.p99_error_over_jnd,
                        interval.low,          interval.high,
                        1e-9 * tick.low_ns,    1e-9 * tick.high_ns};
    // The two sizes of a method follow each other.
    const ModelResult& next = data.models[shown[std::min(k + 1, shown.size() - 1)]];
    if (next.time.measured && &next != &one && family_name(*next.plan) == family_name(*one.plan)) {
      panel.series.push_back({"",
                              model_colour(one),
                              Mark::line,
                              {{point.x, point.y}, {1e-9 * next.time.tick.median_ns, next.errors.p99_error_over_jnd}}});
    }
    panel.series.push_back({one.name, model_colour(one), mark_of(one, Mark::hollow_bars, Mark::bars), {point}});
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
      "Lower is more accurate, further left is faster; noise: that of the force sensor. Hollow: methods on the "
      "measured "
      "force, as in the paper; filled: the trend and its correction. Bars: six rounds of timing, and the 95 % interval "
      "of the error where there is one. A line joins two numbers of centres of one method.";
  return figure;
}

Figure worst_figure(const ReportData& data) {
  Figure figure;
  const WorstStretch& worst = data.worst;
  std::vector<ComparedModel> models;
  for (const std::size_t i : worst.models) {
    const ModelResult& model = data.models[i];
    models.push_back({{model.name, model_colour(model), mark_of(model, Mark::dashed, Mark::line), {}}, data.scene.jnd});
  }
  figure.plot.name = "worst_stretch";
  figure.plot.panels = compared_forces(worst.recording, models, worst.rows);
  figure.plot.height = 0.8;
  figure.caption = "The worst " + three_digits(worst.rows.back().time_s - worst.rows.front().time_s) + " s of " +
                   data.models[data.choice.recommended].name + " (largest mean squared error over the JND): RMS " +
                   three_digits(std::sqrt(std::max(0.0, worst.score))) +
                   " JND. Below: model minus measurement; grey: below the just noticeable difference.";
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
      "Error divided by the JND against force, in bins two JND wide; " + omitted_bins(data) +
      ". Figures 5 and 7 of Hoever & Harders (2009) show the error divided by the force (drawn by palpate paper).";
  return figure;
}

}  // namespace palpate
