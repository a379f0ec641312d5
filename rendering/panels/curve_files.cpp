#include "rendering/panels/curve_files.h"

#include <cmath>
#include <utility>

#include "engine/base/text.h"

namespace palpate {
namespace {

constexpr double kFigure_jnd = 3.0;

std::string number(float value) { return std::isnan(value) ? "" : general(value, 6); }

}  // namespace

Plot curve_plot(const CurveColumns& columns, const CurveSource& source) {
  Panel force;
  force.title = source.title + "; compared with: " + source.reference;
  force.y = {"Force [N]", "", false, 0.0};
  force.series = {{"within 1 JND", kMutedColour, Mark::area, {}}, {"reference", kMeasuredColour, Mark::line, {}}};
  Panel difference;
  difference.x.title = "Time [s]";
  difference.y = {"Difference [JND]", "", false, -kFigure_jnd, kFigure_jnd};
  difference.series = {force.series[0]};
  for (const CurveModel& model : source.models) {
    force.series.push_back({model.name, model.colour, Mark::line, {}});
    difference.series.push_back({model.name, model.colour, Mark::line, {}});
  }
  for (Panel* panel : {&force, &difference}) {
    panel->x.low = source.from_s - source.zero_s;
    panel->x.high = source.to_s - source.zero_s;
  }
  for (const CurveColumn& column : columns.columns()) {
    const HistoryPoint& tick = column.tick;
    if (!column.any || tick.loop_time_s < source.from_s || tick.loop_time_s > source.to_s) continue;
    const double time_s = tick.loop_time_s - source.zero_s;
    const double reference_N = tick.reference_N;
    const double jnd_N = column.jnd_N;
    force.series[0].rows.push_back({time_s, reference_N, reference_N - jnd_N, reference_N + jnd_N});
    force.series[1].rows.push_back({time_s, reference_N});
    difference.series[0].rows.push_back({time_s, 0.0, -1.0, 1.0});
    for (std::size_t i = 0; i < source.models.size(); ++i) {
      const std::size_t slot = source.models[i].slot;
      force.series[i + 2].rows.push_back({time_s, static_cast<double>(tick.force_N[slot])});
      difference.series[i + 1].rows.push_back({time_s, tick.difference_over_jnd(slot, source.jnd)});
    }
  }
  Plot plot;
  plot.name = "curves";
  plot.height = 1.2;  // with room for the legend of many models
  plot.panels = {std::move(force), std::move(difference)};
  return plot;
}

std::string curve_csv(const ForceHistory& history, const CurveSource& source) {
  std::string csv =
      "# " + source.title + "; compared with: " + source.reference + "\ntime_s,depth_m,reference_N,rendered_N";
  for (const CurveModel& model : source.models) csv.append(",").append(model.name).append("_N");
  csv += "\n";
  for (std::size_t i = history.first_at(source.from_s); i < history.size() && history[i].loop_time_s <= source.to_s;
       ++i) {
    const HistoryPoint& point = history[i];
    csv += fixed(point.loop_time_s - source.zero_s, 6) + "," + number(point.depth_m) + "," + number(point.reference_N) +
           "," + number(point.rendered_N);
    for (const CurveModel& model : source.models) csv.append(",").append(number(point.force_N[model.slot]));
    csv += "\n";
  }
  return csv;
}

}  // namespace palpate
