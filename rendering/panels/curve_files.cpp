#include "rendering/panels/curve_files.h"

#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "engine/base/text.h"
#include "rendering/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr double kFigure_jnd = 3.0;

std::string number(float value) { return std::isnan(value) ? "" : general(value, 6); }

std::string title_of(const WindowView& shown, const std::string& source) {
  return source + "; compared with: " + shown.reference_words;
}

Series curve_of(const ModelsView& models, std::size_t slot) {
  const glm::uvec3 parts(glm::round(255.0F * slot_colour(models, slot, Theme::light)));
  return {models.slots[slot].name, parts.r << 16 | parts.g << 8 | parts.b, Mark::line, {}};
}

}  // namespace

Plot curve_plot(const CurveColumns& columns, const WindowView& shown, const CurveTime& time,
                const std::string& source) {
  const std::vector<std::size_t> slots = shown.models.drawn();
  const double to_s = time.end_s(shown.now_s), from_s = to_s - time.shown_s;
  Panel force, difference;
  force.title = title_of(shown, source);
  force.y = {"Force [N]", "", false, 0.0};
  force.series = {{"within 1 JND", kMutedColour, Mark::area, {}}, {"reference", kMeasuredColour, Mark::line, {}}};
  difference.x.title = "Time [s]";
  difference.y = {"Difference [JND]", "", false, -kFigure_jnd, kFigure_jnd};
  difference.series = {force.series[0]};
  for (const std::size_t slot : slots)
    for (Panel* panel : {&force, &difference}) panel->series.push_back(curve_of(shown.models, slot));
  for (Panel* panel : {&force, &difference}) {
    panel->x.low = from_s - time.zero_s;
    panel->x.high = to_s - time.zero_s;
  }
  for (const CurveColumn& column : columns.columns()) {
    const HistoryPoint& tick = column.tick;
    if (!column.any || tick.loop_time_s < from_s || tick.loop_time_s > to_s) continue;
    const double time_s = tick.loop_time_s - time.zero_s, reference_N = tick.reference_N, jnd_N = column.jnd_N;
    force.series[0].rows.push_back({time_s, reference_N, reference_N - jnd_N, reference_N + jnd_N});
    force.series[1].rows.push_back({time_s, reference_N});
    difference.series[0].rows.push_back({time_s, 0.0, -1.0, 1.0});
    for (std::size_t i = 0; i < slots.size(); ++i) {
      force.series[i + 2].rows.push_back({time_s, static_cast<double>(tick.force_N[slots[i]])});
      difference.series[i + 1].rows.push_back({time_s, tick.difference_over_jnd(slots[i], shown.models.jnd)});
    }
  }
  Plot plot;
  plot.name = "curves";
  plot.height = 1.2;  // with room for the legend of many models
  plot.panels = {std::move(force), std::move(difference)};
  return plot;
}

std::string curve_csv(const WindowView& shown, const CurveTime& time, const std::string& source) {
  const ForceHistory& history = *shown.history;
  const double to_s = time.end_s(shown.now_s);
  std::string csv = "# " + title_of(shown, source) + "\ntime_s,depth_m,reference_N,rendered_N";
  const std::vector<std::size_t> slots = shown.models.drawn();
  for (const std::size_t slot : slots) csv.append(",").append(shown.models.slots[slot].name).append("_N");
  csv += "\n";
  for (std::size_t i = history.first_at(to_s - time.shown_s); i < history.size(); ++i) {
    const HistoryPoint& point = history[i];
    if (point.loop_time_s > to_s) break;
    csv += fixed(point.loop_time_s - time.zero_s, 6) + "," + number(point.depth_m) + "," + number(point.reference_N) +
           "," + number(point.rendered_N);
    for (const std::size_t slot : slots) csv.append(",").append(number(point.force_N[slot]));
    csv += "\n";
  }
  return csv;
}

}  // namespace palpate
