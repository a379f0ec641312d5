#include "scenes/live/session_recorder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "engine/import/import_table.h"
#include "models/samples/samples.h"
#include "scenes/scene/scene.h"

namespace palpate {

bool may_be_recording(const std::string& path) {
  const std::filesystem::path ending = std::filesystem::path(path).extension();
  return !ending.empty() && ending != ".json";
}

Result<ConvertedRecording> convert_recording(const std::string& path, const std::string& folder) {
  const auto recording = read_recording(path);
  if (recording) return ConvertedRecording{path, {}};
  // A file with the header of a recording is no table of another program.
  std::error_code missing;
  if (read_recording(path, 0) || !std::filesystem::exists(path, missing)) return recording.error();
  const ImportRequest request;
  const auto table = import_table(path, request);
  if (!table) return table.error();
  ConvertedRecording converted;
  converted.path = folder + "/" + std::filesystem::path(path).stem().string() + local_time_text("-%Y%m%d-%H%M%S.csv");
  if (Status status = check_limits(path, request, *table); !status) return status.error();
  if (Status status = write_recording(converted.path, table->recording, import_origin(path, request, *table), true);
      !status)
    return status.error();
  converted.words.push_back(layout_words(*table));
  for (const std::string& rows : row_words(*table)) converted.words.push_back("rows: " + rows);
  for (std::size_t role = 0; role < kRoles; ++role)
    converted.words.push_back(std::string(kRoleNames[role]) + ": " + column_words(table->columns[role]));
  converted.words.insert(converted.words.end(), table->notes.begin(), table->notes.end());
  return converted;
}

std::optional<Recording> take_test_part(Recording& recording) {
  constexpr std::size_t kLeastRows = 100;
  std::vector<RecordingRow>& rows = recording.rows;
  if (rows.size() < kLeastRows) return std::nullopt;
  const auto first = rows.begin() + static_cast<std::ptrdiff_t>(first_test_row(recording));
  Recording part{recording.name + ", last " + fixed(rows.back().time_s - first->time_s, 1) + " s",
                 recording.columns,
                 {first, rows.end()}};
  rows.erase(first, rows.end());
  return part;
}

bool limit_hand(const std::vector<Recording>& recordings, HandSettings& hand) {
  constexpr double kInside = 0.8;  // of the largest values, because the simulated hand overshoots
  constexpr double kSpan_s = 0.02;
  double strongest_N = 0.0, deepest_m = 0.0;
  std::vector<double> speeds_m_per_s;  // in contact
  for (const Recording& recording : recordings) {
    RecordingRow before = recording.rows.front();
    for (const RecordingRow& row : recording.rows) {
      strongest_N = std::max(strongest_N, row.force_N);
      deepest_m = std::max(deepest_m, row.position_m);
      const double span_s = row.time_s - before.time_s;
      if (span_s < kSpan_s) continue;
      if (row.position_m > 0.0) speeds_m_per_s.push_back(std::abs(row.position_m - before.position_m) / span_s);
      before = row;
    }
  }
  if (strongest_N <= 0.0) return false;
  hand.strongest_press_N = kInside * strongest_N;
  if (deepest_m > 0.0) hand.deepest_m = kInside * deepest_m;
  if (speeds_m_per_s.empty()) return true;
  hand.fastest_m_per_s = kInside * quantile_of(std::move(speeds_m_per_s), 99);
  return true;
}

}  // namespace palpate
