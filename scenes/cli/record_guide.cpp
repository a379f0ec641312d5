#include "scenes/cli/record_guide.h"

#include <algorithm>
#include <utility>

#include "engine/base/text.h"
#include "engine/live/pacer.h"

namespace palpate::cli {
namespace {

constexpr double kPeriod_s = 2.0;
constexpr double kRest = 10.0;  // pause after a check, as a multiple of its duration
constexpr int kSmallStrokes = 10;

constexpr const char* kPresses[kSpeedBands] = {
    "press slowly: five seconds in and five seconds out",
    "press at normal speed: half a second in and half a second out",
    "press fast: quick taps, in and out without a pause",
};

bool visited(const RecordingMeasures& measures, std::size_t quarter, std::size_t band) {
  return measures.seconds[quarter][band] >= kLeastCell_s;
}

}  // namespace

std::string guide_advice(const RecordingMeasures& measures, double longest_relaxation_s) {
  for (std::size_t band = 0; band < kSpeedBands; ++band) {
    for (std::size_t quarter = 0; quarter < kDepthQuarters; ++quarter) {
      if (!visited(measures, quarter, band)) return kPresses[band];
    }
  }
  // The same criterion and advice as in `palpate check`.
  if (measures.longest_hold_s < longest_relaxation_s) {
    return "press, and hold still for " + fixed(2.0 * longest_relaxation_s, 1) + " s";
  }
  if (measures.small_strokes < kSmallStrokes)
    return "make small strokes: stay in the block and move a little in and out";
  return {};
}

std::vector<std::string> guide_cells(const RecordingMeasures& measures, double surface_m) {
  std::string names = "  depth [mm]     ";
  for (const std::string& name : speed_band_names(measures)) names.append(name).append("  ");
  std::vector<std::string> lines = {names};
  const double deepest_mm = 1e3 * (measures.highest_position_m - surface_m);
  for (std::size_t quarter = 0; quarter < kDepthQuarters; ++quarter) {
    const auto edge = [&](std::size_t i) { return fixed(0.25 * static_cast<double>(i) * deepest_mm, 2); };
    std::string line = "  " + edge(quarter) + " to " + edge(quarter + 1);
    line.resize(std::max<std::size_t>(line.size(), 17), ' ');
    for (std::size_t band = 0; band < kSpeedBands; ++band) {
      std::string cell = visited(measures, quarter, band) ? fixed(measures.seconds[quarter][band], 1) + " s" : "-";
      cell.resize(15, ' ');
      line += cell;
    }
    lines.push_back(line);
  }
  return lines;
}

RecordGuide::RecordGuide(std::string path, const CheckRequest& request) : path_(std::move(path)), request_(request) {}

std::vector<std::string> RecordGuide::update(double now_s) {
  if (now_s < next_s_) return {};
  next_s_ = now_s + kPeriod_s;
  // The file does not exist before its first 1000 rows.
  const auto file = check_recording_file(path_, request_);
  next_s_ = std::max(next_s_, now_s + kRest * (steady_now_s() - now_s));
  const auto is_new = [&](const std::string& text) { return std::exchange(printed_, text) != text; };
  if (!file || file->check.measures.contact_rows == 0) {
    const std::string touch = "next: touch the block, then press it slowly";
    return is_new(touch) ? std::vector<std::string>{touch} : std::vector<std::string>{};
  }
  const RecordingMeasures& measures = file->check.measures;
  const std::string advice = guide_advice(measures, request_.longest_relaxation_s);
  std::string cells;
  for (const auto& quarter : measures.seconds) {
    for (const double seconds : quarter) cells += seconds >= kLeastCell_s ? '+' : '-';
  }
  if (!is_new(advice + cells)) return {};
  std::vector<std::string> lines = guide_cells(measures, file->check.surface_offset_m);
  lines.push_back(advice.empty() ? "  nothing is missing: Ctrl-C ends the recording" : "  next: " + advice);
  return lines;
}

}  // namespace palpate::cli
