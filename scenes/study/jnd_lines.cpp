#include "scenes/study/jnd_lines.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "scenes/study/psychometrics.h"

namespace palpate {
namespace {

using OrderedJson = nlohmann::ordered_json;

Error useless_line(const JndLine& line, const char* what) {
  char text[200];
  std::snprintf(text, sizeof text,
                "the conservative line through the JNDs is %.4f N + %.2f %%, expected %s; more subjects or more "
                "trials may help",
                line.offset_N, 100.0 * line.weber_fraction, what);
  return Error{text};
}

}  // namespace

Result<JndLines> fit_jnd_lines(const std::vector<JndPoint>& points) {
  const double count = static_cast<double>(points.size());
  double mean_force = 0.0, mean_jnd = 0.0;
  for (const JndPoint& point : points) {
    mean_force += point.reference_N / count;
    mean_jnd += point.jnd_N / count;
  }
  double squares = 0.0, products = 0.0;
  for (const JndPoint& point : points) {
    squares += (point.reference_N - mean_force) * (point.reference_N - mean_force);
    products += (point.reference_N - mean_force) * (point.jnd_N - mean_jnd);
  }
  if (points.size() < 2 || !(squares > 1e-6)) {
    return Error{"found JNDs at fewer than two reference forces, expected two or more for a line"};
  }
  JndLines lines;
  lines.fitted = {mean_jnd - products / squares * mean_force, products / squares};
  lines.conservative = lines.fitted;
  for (const JndPoint& point : points) {
    lines.conservative.offset_N =
        std::min(lines.conservative.offset_N, point.jnd_N - lines.fitted.weber_fraction * point.reference_N);
  }
  if (lines.conservative.weber_fraction < 0.0)
    return useless_line(lines.conservative, "JNDs that do not fall with the force");
  if (lines.conservative.offset_N <= 0.0) return useless_line(lines.conservative, "one that is above 0 N at no force");
  return lines;
}

std::vector<JndPoint> pang_tan_durlach_points() { return {{2.5, 0.09 * 2.5, 0.0, "Pang, Tan & Durlach (1991)"}}; }

std::string jnd_file_text(const JndLines& lines, const std::vector<JndPoint>& points,
                          const std::vector<std::string>& subjects) {
  OrderedJson list = OrderedJson::array();
  for (const JndPoint& point : points) {
    OrderedJson entry = {{"reference_N", point.reference_N}, {"jnd_N", point.jnd_N}};
    if (point.standard_error_N > 0.0) entry["standard_error_N"] = point.standard_error_N;
    entry["source"] = point.source;
    list.push_back(entry);
  }
  const OrderedJson document = {
      {"format", "palpate-jnd"},
      {"version", 1},
      {"offset_N", lines.conservative.offset_N},
      {"weber_fraction", lines.conservative.weber_fraction},
      {"criterion", kJndCriterion},
      {"subjects", subjects},
      {"fitted", {{"offset_N", lines.fitted.offset_N}, {"weber_fraction", lines.fitted.weber_fraction}}},
      {"points", list}};
  return document.dump(2) + "\n";
}

}  // namespace palpate
