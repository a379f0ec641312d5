#include "rendering/panels/curve_files.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <functional>

#include "rendering/ui/plot.h"

namespace palpate {
namespace {

constexpr double kWidth_px = 900.0, kLeft_px = 60.0, kRight_px = 130.0;
constexpr double kFigure_jnd = 3.0;
// Of a ReferenceKind: what reference_N was in that row, which F changes.
constexpr const char* kReferenceNames[] = {"measured", "truth", "model"};

__attribute__((format(printf, 1, 2))) std::string print(const char* pattern, ...) {
  char text[256];
  va_list values;
  va_start(values, pattern);
  std::vsnprintf(text, sizeof text, pattern, values);
  va_end(values);
  return text;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    if (letter == '<') {
      result += "&lt;";
    } else if (letter == '&') {
      result += "&amp;";
    } else {
      result += letter;
    }
  }
  return result;
}

std::string hex(const Rgb& colour) {
  const auto part = [](float value) {
    return static_cast<unsigned>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F)));
  };
  return print("#%02X%02X%02X", part(colour.r), part(colour.g), part(colour.b));
}

// One of the two frames.
struct Frame {
  double top_px, height_px;
  Range x, y;
  double x_px(double value) const {
    return kLeft_px + (value - x.from) / (x.to - x.from) * (kWidth_px - kLeft_px - kRight_px);
  }
  double y_px(double value) const {
    return top_px + height_px * (1.0 - std::clamp((value - y.from) / (y.to - y.from), 0.0, 1.0));
  }
};

std::string axes(const Frame& frame, const std::string& title) {
  std::string svg;
  const double y_step = tick_step(frame.y.to - frame.y.from, 6);
  for (double y = std::ceil(frame.y.from / y_step) * y_step; y <= frame.y.to + 1e-9; y += y_step) {
    svg += print("<path d='M%.1f %.1fH%.1f' stroke='#DDD'/><text x='%.1f' y='%.1f' text-anchor='end'>%g</text>\n",
                 kLeft_px, frame.y_px(y), kWidth_px - kRight_px, kLeft_px - 6.0, frame.y_px(y) + 4.0,
                 std::abs(y) < 1e-9 ? 0.0 : y);
  }
  const double x_step = tick_step(frame.x.to - frame.x.from, 10);
  for (double x = std::ceil(frame.x.from / x_step) * x_step; x <= frame.x.to + 1e-9; x += x_step) {
    svg += print("<path d='M%.1f %.1fV%.1f' stroke='#DDD'/><text x='%.1f' y='%.1f' text-anchor='middle'>%.7g</text>\n",
                 frame.x_px(x), frame.top_px, frame.top_px + frame.height_px, frame.x_px(x),
                 frame.top_px + frame.height_px + 16.0, std::abs(x) < 1e-9 ? 0.0 : x);
  }
  return svg + print("<text x='%.1f' y='%.1f' font-weight='bold'>", kLeft_px, frame.top_px - 8.0) + escaped(title) +
         "</text>\n";
}

using Value = std::function<float(const CurveColumn&)>;

std::string curve(const Frame& frame, const CurveColumns& columns, double zero_s, const std::string& colour,
                  double width, const Value& value) {
  std::string path;
  bool open = false;
  for (const CurveColumn& column : columns.columns()) {
    const double x = column.tick.loop_time_s - zero_s;
    if (!column.any || x < frame.x.from || x > frame.x.to) continue;
    const auto y = static_cast<double>(value(column));
    if (std::isnan(y)) {
      open = false;
      continue;
    }
    path += print("%c%.1f %.1f", open ? 'L' : 'M', frame.x_px(x), frame.y_px(y));
    open = true;
  }
  return std::string("<path d='") + path + "' fill='none' stroke='" + colour +
         print("' stroke-width='%.1f'/>\n", width);
}

std::string band(const Frame& frame, const CurveColumns& columns, double zero_s) {
  std::string upper, lower;
  for (const CurveColumn& column : columns.columns()) {
    const double x = column.tick.loop_time_s - zero_s;
    if (!column.any || std::isnan(column.jnd_N) || x < frame.x.from || x > frame.x.to) continue;
    upper +=
        print("%.1f,%.1f ", frame.x_px(x), frame.y_px(static_cast<double>(column.tick.reference_N + column.jnd_N)));
    lower =
        print("%.1f,%.1f ", frame.x_px(x), frame.y_px(static_cast<double>(column.tick.reference_N - column.jnd_N))) +
        lower;
  }
  return std::string("<polygon points='") + upper + lower + "' fill='#D5D9DD'/>\n";
}

std::string names(const Frame& frame, const CurveColumns& columns, const std::vector<CurveModel>& models) {
  std::vector<float> wanted;
  const CurveColumn* last = columns.last();
  for (const CurveModel& model : models) {
    const float value = last != nullptr ? last->tick.force_N[model.slot] : 0.0F;
    wanted.push_back(static_cast<float>(frame.y_px(std::isnan(value) ? 0.0 : static_cast<double>(value))));
  }
  const std::vector<float> places = spread_labels(wanted, 15.0F, static_cast<float>(frame.top_px),
                                                  static_cast<float>(frame.top_px + frame.height_px));
  std::string svg;
  for (std::size_t i = 0; i < models.size(); ++i) {
    svg += print("<text x='%.1f' y='%.1f' fill='", kWidth_px - kRight_px + 6.0, static_cast<double>(places[i]) + 4.0) +
           hex(models[i].colour) + "'>" + escaped(models[i].name) + "</text>\n";
  }
  return svg;
}

}  // namespace

std::string curve_svg(const CurveColumns& columns, const CurveSource& source, double from_s, double to_s) {
  const Range time{from_s - source.zero_s, to_s - source.zero_s};
  const double highest_N = round_up(std::max(1.0, static_cast<double>(columns.highest_force_N())));
  const Frame force{50.0, 230.0, time, {0.0, highest_N}};
  const Frame difference{340.0, 200.0, time, {-kFigure_jnd, kFigure_jnd}};
  std::string svg = print(
                        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 %.0f 580' width='%.0f' height='580' "
                        "font-family='DejaVu Sans, sans-serif' font-size='12' fill='#222'>\n",
                        kWidth_px, kWidth_px) +
                    std::string("<rect width='100%' height='100%' fill='white'/>\n<text x='60' y='20'>") +
                    escaped(source.scene) + ", " + escaped(source.device) + "; green: " + escaped(source.reference) +
                    "</text>\n";
  svg += axes(force, "Force, N, with one JND to either side") + band(force, columns, source.zero_s);
  const std::string green = hex(kReferenceColour);
  svg += curve(force, columns, source.zero_s, green, 2.4, [](const CurveColumn& c) { return c.tick.reference_N; });
  svg += print("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' fill='#D5D9DD'/>\n", kLeft_px, difference.y_px(1.0),
               kWidth_px - kLeft_px - kRight_px, difference.y_px(-1.0) - difference.y_px(1.0));
  svg += axes(difference, "Difference, JND: inside the band a hand cannot tell (seconds below)");
  for (const CurveModel& model : source.models) {
    const std::size_t slot = model.slot;
    svg += curve(force, columns, source.zero_s, hex(model.colour), 1.4,
                 [slot](const CurveColumn& c) { return c.tick.force_N[slot]; });
    svg += curve(difference, columns, source.zero_s, hex(model.colour), 1.4, [&, slot](const CurveColumn& c) {
      return static_cast<float>(c.tick.difference_over_jnd(slot, source.jnd));
    });
  }
  return svg + names(force, columns, source.models) + "</svg>\n";
}

std::string curve_csv(const ForceHistory& history, const CurveSource& source, double from_s, double to_s) {
  const auto number = [](float value) {
    return std::isnan(value) ? std::string() : print("%.6g", static_cast<double>(value));
  };
  std::string csv = std::string("# ") + source.scene + ", " + source.device +
                    "; now compared with: " + source.reference + "\ntime_s,depth_m,reference,reference_N,rendered_N";
  for (const CurveModel& model : source.models) csv.append(",").append(model.name).append("_N");
  csv += "\n";
  for (std::size_t i = history.first_at(from_s); i < history.size() && history[i].loop_time_s <= to_s; ++i) {
    const HistoryPoint& point = history[i];
    csv += print("%.6f,", point.loop_time_s - source.zero_s) + number(point.depth_m) + "," +
           (std::isnan(point.reference_N) ? "" : kReferenceNames[point.reference]) + "," + number(point.reference_N) +
           "," + number(point.rendered_N);
    for (const CurveModel& model : source.models) csv.append(",").append(number(point.force_N[model.slot]));
    csv += "\n";
  }
  return csv;
}

}  // namespace palpate
