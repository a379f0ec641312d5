#include "scenes/report/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

#include "engine/base/text.h"
#include "models/correction/methods.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/plot/plot.h"

namespace palpate {
namespace {

constexpr int kThree = TableColumn::kThreeDigits;

// A figure over the seeds of a method that draws random numbers.
TableCell of_seeds(const ModelResult& one, double value) { return one.seeds > 1 ? value : kNoNumber; }

Table models_table(const ReportData& data) {
  Table table{"models"};
  for (const ModelResult& one : data.models) {
    const UnitErrors& errors = one.errors;
    const Interval p99 = errors.p99_interval();
    const UnitErrors& best = data.models[data.choice.best].errors;
    const Interval difference = p99_difference(errors, best);
    table.begin_row();
    table.add({"model", "model"}, one.name);
    table.add({"size", "size"}, one.size);
    table.add({"rank", "rank"}, one.rank > 0 ? TableCell(one.rank) : TableCell(kNoNumber));
    table.add({"seeds", "seeds"}, one.seeds);
    table.add({"seed", ""}, one.plan ? one.plan->seed : 0);
    table.add({"contact_samples", "samples"}, errors.samples);
    table.add({"within_jnd", "≤ JND [%], seeds", kInPercent, 2, 2}, errors.within_jnd);
    table.add({"within_jnd_least", "", kInPercent, 2}, of_seeds(one, one.within_range.low));
    table.add({"within_jnd_greatest", "", kInPercent, 2}, of_seeds(one, one.within_range.high));
    table.add({"within_at_least", "at least [%]", kInPercent, 2}, errors.within_at_least());
    table.add({"p99_error_over_jnd", "99 % error [JND], 95 %", 1.0, kThree, 2}, errors.p99_error_over_jnd);
    table.add({"p99_error_over_jnd_low", ""}, p99.low);
    table.add({"p99_error_over_jnd_high", ""}, p99.high);
    table.add({"p99_least", "seeds from"}, of_seeds(one, one.p99_range.low));
    table.add({"p99_greatest", "to"}, of_seeds(one, one.p99_range.high));
    table.add({"difference_p99", "minus the best, 95 %", 1.0, kThree, 2},
              errors.p99_error_over_jnd - best.p99_error_over_jnd);
    table.add({"difference_p99_low", ""}, difference.low);
    table.add({"difference_p99_high", ""}, difference.high);
    table.add({"rms_error_N", "RMS [mN]", kInMilli}, errors.rms_error_N);
    table.add({"max_error_N", "worst [mN]", kInMilli}, errors.max_error_N);
    table.add({"max_error_over_jnd", "worst [JND]"}, errors.max_error_over_jnd);
    table.add({"units", errors.units_are_recordings ? "recordings" : "strokes"}, errors.units());
    table.add({"beyond_units", "beyond"}, errors.units_above_jnd);
    table.add({"out_of_domain_samples", ""}, errors.out_of_domain_samples);
    table.add({"moved_within_jnd", "moved: ≤ JND [%]", kInPercent, 2}, one.moved.within_jnd);
    table.add({"moved_p99_error_over_jnd", "99 % [JND]"}, one.moved.p99_error_over_jnd);
    table.add({"moved_rms_error_N", "RMS [mN]", kInMilli}, one.moved.rms_error_N);
    table.add({"untared_within_jnd", "force as recorded: ≤ JND [%]", kInPercent, 2},
              one.untared.samples > 0 ? one.untared.within_jnd : kNoNumber);
    table.add({"bound_95_held", "≤ bound [%], moved", kInPercent, 1, 1}, errors.bound.coverage);
    table.add({"bound_95_held_moved", "", kInPercent, 1}, one.moved.bound.coverage);
    table.add({"median_bound_N", ""}, errors.bound.median_N);
    const bool wide = errors.bound.has_bounds() && !std::isfinite(errors.bound.median_over_jnd);
    table.add({"median_bound_over_jnd", "bound [JND]"},
              wide ? TableCell("not known") : TableCell(errors.bound.median_over_jnd));
  }
  return table;
}

Table times_table(const ReportData& data) {
  Table table{"times", true};
  for (const ModelResult& one : data.models) {
    if (!one.time.measured) continue;
    table.begin_row();
    table.add({"model", "model"}, one.name);
    table.add({"tick_ns", "tick [ns]", 1.0, 0, 2}, one.time.tick.median_ns);
    table.add({"tick_low_ns", "", 1.0, 0}, one.time.tick.low_ns);
    table.add({"tick_high_ns", "", 1.0, 0}, one.time.tick.high_ns);
    table.add({"tick_p99_ns", "p99 [ns]", 1.0, 0}, one.time.tick.p99_ns);
    table.add({"evaluation_ns", "evaluation [ns]", 1.0, 0}, one.time.evaluation.median_ns);
    table.add({"evaluation_p99_ns", "p99 [ns]", 1.0, 0}, one.time.evaluation.p99_ns);
    table.add({"fit_seconds", "fit [s]"}, one.fit_seconds);
  }
  return table;
}

Table recordings_table(const ReportData& data) {
  Table table{"recordings"};
  const RecordingSet& set = data.recordings;
  for (std::size_t i = 0; i < set.all.size(); ++i) {
    const auto& [name, columns, rows] = set.all[i]->recording;
    const double seconds = rows.back().time_s - rows.front().time_s;
    char hash[24];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(set.all[i]->content_hash));
    table.begin_row();
    table.add({"role", "role"}, i >= set.trained ? "test" : set.is_tested(i) ? "both" : "train");
    table.add({"name", "recording"}, name);
    table.add({"samples", "samples"}, rows.size());
    table.add({"contact_samples", "in contact"}, data.contact.at(set.all[i].get()));
    table.add({"seconds", "[s]"}, seconds);
    table.add({"rate_Hz", "[Hz]"}, static_cast<double>(rows.size() - 1) / seconds);
    table.add({"deepest_m", "deepest [mm]", kInMilli},
              std::ranges::max_element(rows, {}, &RecordingRow::position_m)->position_m);
    table.add({"largest_force_N", "largest [N]"}, largest_force_N(set.all[i]->recording));
    table.add({"force_noise_N", "force noise [mN]", kInMilli},
              is_force_noise_known(*set.all[i]) ? set.all[i]->force_noise_N : kNoNumber);
    table.add({"accelerometer", "accelerometer"}, yes_or_no(columns.acceleration));
    table.add({"content_hash", ""}, hash);
  }
  return table;
}

Table bins_table(const ReportData& data) {
  Table table{"force_bins"};
  for (const ModelResult& one : data.models) {
    for (const ForceBin& bin : one.errors.bins) {
      if (!one.plan || bin.force_N.count() == 0) continue;
      table.begin_row();
      table.add({"model", ""}, one.name);
      table.add({"force_from_N", ""}, bin.force_from_N);
      table.add({"force_to_N", ""}, bin.force_to_N);
      table.add({"count", ""}, bin.force_N.count());
      table.add({"mean_force_N", ""}, bin.force_N.mean());
      table.add_moments("abs_error_N", bin.error_N);
      table.add_moments("error_over_jnd", bin.over_jnd);
    }
  }
  return table;
}

// The name, and those of the other main models with the same forces.
std::string name_with_same(const ModelResult& model) {
  std::string name = model.name;
  for (const std::string& other : model.same) {
    if (const auto plan = parse_plan(other); plan && is_main(*plan)) name += " = " + other;
  }
  return name;
}

constexpr std::size_t kWorstModels = 3;  // in the figure of the worst stretch
// The curves in the page: the extremes of so many groups of rows, and every row this near to a largest error.
constexpr std::size_t kGroups = 900;
constexpr double kWholeNear_s = 0.05;
constexpr double kNear = 0.2;  // the budget, the period of a tick, is drawn if a tick takes more than this share of it

// The colour of the model's method, which the window uses as well; grey for no force.
Hue model_colour(const ModelResult& model) { return model.plan ? Hue(colour_of(*model.plan)) : kMutedColour; }

Mark mark_of(const ModelResult& model, Mark on_force, Mark on_trend) {
  return model.plan && model.plan->base == Base::force ? on_force : on_trend;
}

using BinFigure = double (*)(const ForceBin&);

// Error against force of the headline models with this base and 100 centres.
Panel force_panel(const ReportData& data, const std::string& title, Base base, BinFigure figure) {
  Panel panel{.title = title + (base == Base::force ? ", on the force" : ", on the trend"),
              .x = {"Measured force [N]"},
              .y = {"Error [JND]", "", true},
              .levels = {{1.0, "1 JND"}},
              .names_at_ends = true};
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

Plot speed_figure(const ReportData& data) {
  Panel panel{.x = {"Time of a whole tick, log", "s", true},
              .y = {"99 % of the errors are below [JND], log", "", true},
              .levels = {{1.0, "1 JND"}},
              .names_at_ends = true};
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
    panel.series.push_back(
        {one.name,
         model_colour(one),
         one.plan->method == &kTrendMethod ? Mark::square_bars : mark_of(one, Mark::hollow_bars, Mark::bars),
         {point}});
  }
  if (data.floor.p99_error_over_jnd > 0.3 * least) panel.levels.push_back({data.floor.p99_error_over_jnd, "noise"});
  if (slowest_s > kNear * kHapticTick_s) {
    panel.levels.push_back({kHapticTick_s, "budget 1 ms", true});
  } else {
    panel.x.title += " (the budget, 1 ms, is off to the right)";
  }
  // Room for names on the left of the fastest models.
  const AxisRange times = range_of(panel, false);
  panel.x.low = times.low * std::pow(times.low / times.high, 0.2);
  return {
      .name = "speed_error",
      .width = 0.75,
      .height = 1.9,
      .panels = {std::move(panel)},
      .caption =
          "Lower is more accurate, further left is faster; noise: that of the force sensor. Hollow: methods on the "
          "measured force, as in the paper; square: the trend; filled: the trend and its correction. Horizontal bars: "
          "spread of the time; vertical: 95 % interval. A line joins two numbers of centres of one method."};
}

Plot worst_figure(const ReportData& data) {
  const TestCurves& curves = data.curves;
  std::vector<ComparedModel> models;
  for (const std::size_t i : curves.models) {
    const ModelResult& model = data.models[i];
    if (models.size() < kWorstModels)
      models.push_back(
          {{model.name, model_colour(model), mark_of(model, Mark::dashed, Mark::line), {}}, data.scene.jnd});
  }
  const std::vector<ComparedMoment> rows(curves.moments.begin() + static_cast<std::ptrdiff_t>(curves.first),
                                         curves.moments.begin() + static_cast<std::ptrdiff_t>(curves.last) + 1);
  return {.name = "worst_stretch",
          .height = 0.8,
          .panels = compared_forces(curves.recording->name, models, rows),
          .caption = "The worst " + three_digits(rows.back().time_s - rows.front().time_s) + " s of " +
                     data.models[data.choice.recommended].name + " (largest mean squared error over the JND): RMS " +
                     three_digits(std::sqrt(std::max(0.0, curves.score))) +
                     " JND. Below: model minus measurement; grey: within one JND."};
}

Plot force_figure(const ReportData& data) {
  const std::pair<const char*, BinFigure> rows[] = {
      {"Mean + deviation", [](const ForceBin& bin) { return bin.over_jnd.mean() + bin.over_jnd.deviation(); }},
      {"Maximum", [](const ForceBin& bin) { return bin.over_jnd.largest(); }}};
  Plot plot{
      .name = "error_by_force",
      .columns = 2,
      .caption =
          "Error divided by the JND against force, in bins two JND wide; " + omitted_bins(data) +
          ". Figures 5 and 7 of Hoever & Harders (2009) show the error divided by the force (drawn by palpate paper)."};
  for (const auto& [title, value] : rows) {
    Panel paper = force_panel(data, title, Base::force, value);
    Panel palpate = force_panel(data, title, Base::trend, value);
    share_scale(paper, palpate);
    plot.panels.push_back(std::move(paper));
    plot.panels.push_back(std::move(palpate));
  }
  return plot;
}

}  // namespace

Table gains_table(const std::vector<PartGain>& gains) {
  Table table{"features"};
  for (const PartGain& one : gains) {
    table.begin_row();
    table.add({"feature", "feature"}, one.name);
    table.add({"weight_above_0", "used"}, yes_or_no(one.taken));
    table.add({"error_over_jnd_with", "cross-validated error with it [JND]"}, one.error_with);
    table.add({"error_over_jnd_without", "without"}, one.error_without);
  }
  return table;
}

Table headline_table(const ReportData& data) {
  Table table{"headline"};
  for (const std::size_t i : headline_models(data)) {
    const ModelResult& one = data.models[i];
    const UnitErrors& errors = one.errors;
    const Interval interval = errors.p99_interval();
    const auto time = [&](double time_ns) { return one.time.measured ? time_ns : kNoNumber; };
    table.begin_row();
    table.add({"", "model"}, name_with_same(one));
    table.add({"", "centres"}, one.size);
    table.add({"", "rank"}, one.rank > 0 ? TableCell(one.rank) : TableCell(kNoNumber));
    table.add({"", "RMS [mN]", kInMilli}, errors.rms_error_N);
    table.add({"", "within JND [%]", kInPercent, 2, 2}, std::floor(1e4 * errors.within_jnd) / 1e4);
    table.add({"", "", kInPercent, 2}, of_seeds(one, one.within_range.low));
    table.add({"", "", kInPercent, 2}, of_seeds(one, one.within_range.high));
    table.add({"", "99 % error [JND]", 1.0, kThree, 2}, errors.p99_error_over_jnd);
    table.add({}, interval.low);
    table.add({}, interval.high);
    table.add({"", "worst [JND]"}, errors.max_error_over_jnd);
    table.add({"", "tick [ns]", 1.0, 0, 2}, time(one.time.tick.median_ns));
    table.add({"", "", 1.0, 0}, time(one.time.tick.low_ns));
    table.add({"", "", 1.0, 0}, time(one.time.tick.high_ns));
    table.add({"", "by the rule"}, i == 0                                     ? ""
                                   : i == data.choice.recommended             ? "recommended"
                                   : data.choice.as_good[i]                   ? "as good, slower"
                                   : one.time.tick.median_ns > data.budget_ns ? "over the budget"
                                                                              : "worse");
  }
  return table;
}

std::vector<Table> make_tables(const ReportData& data) {
  return {models_table(data), recordings_table(data), bins_table(data), gains_table(data.gains), times_table(data)};
}

std::vector<Plot> make_figures(const ReportData& data) {
  return {speed_figure(data), worst_figure(data), force_figure(data)};
}

std::string curves_json(const ReportData& data) {
  const TestCurves& curves = data.curves;
  const std::vector<ComparedMoment>& moments = curves.moments;
  const JndLine& jnd = data.scene.jnd;
  const std::size_t count = curves.models.size();
  // The measured force, those of the models, and their differences in JND.
  const auto value = [&](const ComparedMoment& one, std::size_t column) {
    return column == 0       ? one.measured_N
           : column <= count ? one.force_N[column - 1]
                             : one.over_jnd(column - count - 1, jnd);
  };
  const std::vector<RecordingRow>& rows = curves.recording->rows;
  const std::size_t skipped = rows.size() - moments.size();
  std::vector<bool> whole(moments.size(), moments.size() <= 2 * kGroups);
  nlohmann::ordered_json models = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < count; ++k) {
    const ModelResult& model = data.models[curves.models[k]];
    const auto size = [&](const ComparedMoment& one) { return one.in_contact ? std::abs(one.over_jnd(k, jnd)) : -1.0; };
    const auto worst = static_cast<std::size_t>(std::ranges::max_element(moments, {}, size) - moments.begin());
    for (std::size_t i = 0; i < moments.size(); ++i)
      if (std::abs(moments[i].time_s - moments[worst].time_s) < kWholeNear_s) whole[i] = true;
    const Motion motion = motion_at(skipped + worst, rows.size(),
                                    [&](std::size_t i) { return std::pair(rows[i].time_s, rows[i].position_m); });
    char colour[8];
    std::snprintf(colour, sizeof colour, "#%06x", model_colour(model) & 0xFFFFFFU);
    models.push_back({{"name", model.name},
                      {"colour", colour},
                      {"worst_s", moments[worst].time_s},
                      {"said", model.name + " errs most, by " + general(size(moments[worst]), 2) + " JND, at " +
                                   fixed(moments[worst].time_s, 2) + " s: " + motion_words(motion) + ", " +
                                   general(1e3 * std::abs(motion.velocity_m_per_s), 2) + " mm/s."}});
  }
  std::string table;
  const auto add_row = [&](double time_s, const std::function<double(std::size_t)>& of) {
    table += (table.empty() ? "[" : ",\n[") + fixed(time_s, 4);
    for (std::size_t column = 0; column <= 2 * count; ++column)
      table += "," + (std::isfinite(of(column)) ? general(of(column), column <= count ? 4 : 3) : "null");
    table += "]";
  };
  const std::size_t group = moments.size() / kGroups + 1;
  for (std::size_t begin = 0; begin < moments.size(); begin += group) {
    const std::size_t end = std::min(begin + group, moments.size());
    const auto from = whole.begin() + static_cast<std::ptrdiff_t>(begin);
    if (std::any_of(from, from + static_cast<std::ptrdiff_t>(end - begin), [](bool one) { return one; })) {
      for (std::size_t i = begin; i < end; ++i)
        add_row(moments[i].time_s, [&](std::size_t column) { return value(moments[i], column); });
      continue;
    }
    // The extremes of each column, in the order of time.
    std::vector<std::pair<double, double>> extremes;
    for (std::size_t column = 0; column <= 2 * count; ++column) {
      std::size_t least = begin, most = begin;
      for (std::size_t i = begin; i < end; ++i) {
        const double here = value(moments[i], column);
        if (!(here >= value(moments[least], column))) least = i;
        if (!(here <= value(moments[most], column))) most = i;
      }
      extremes.emplace_back(value(moments[std::min(least, most)], column),
                            value(moments[std::max(least, most)], column));
    }
    add_row(moments[begin].time_s, [&](std::size_t column) { return extremes[column].first; });
    add_row(moments[(begin + end) / 2].time_s, [&](std::size_t column) { return extremes[column].second; });
  }
  nlohmann::ordered_json dots = nlohmann::ordered_json::array();
  const Panel panel = speed_figure(data).panels.front();
  for (std::size_t k = 0; k < panel.series.size(); ++k)
    if (!panel.series[k].name.empty()) dots.push_back({k + 1, panel.series[k].name});
  const nlohmann::ordered_json about{{"recording", curves.recording->name}, {"models", models}, {"dots", dots}};
  std::string text = about.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  text.replace(text.size() - 1, 1, ",\"rows\":[" + table + "]}");
  return replaced(text, "<", "\\u003c");  // no end of the element within a name
}

}  // namespace palpate
