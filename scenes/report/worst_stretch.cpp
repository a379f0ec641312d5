#include "scenes/report/worst_stretch.h"

#include <algorithm>

namespace palpate {

WorstStretch worst_stretch(const Recording& recording, const std::vector<ModelPointer>& models, const JndLine& jnd,
                           double from_s) {
  std::vector<StretchRow> rows;
  std::vector<double> squares;  // a row, of the first model
  const auto visitor = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
    if (row.time_s < from_s) return;
    const bool contact = snapshot.in_contact;
    const double ratio = jnd.error_over_jnd(snapshot.force_N[0], row.force_N);
    squares.push_back(contact ? ratio * ratio : 0.0);
    rows.push_back({row.time_s, row.force_N, contact, {}});
    rows.back().force_N.assign(snapshot.force_N.begin(), snapshot.force_N.begin() + snapshot.model_count);
  };
  WorstStretch worst;
  worst.recording = recording.name;
  if (!replay(recording, models, visitor).ok()) return worst;
  double sum = 0.0;
  std::size_t contact = 0;
  std::size_t first = 0;
  std::size_t best_first = 0;
  std::size_t best_last = rows.size() - 1;
  const double length_s = std::min(kStretchSeconds, rows.back().time_s - rows.front().time_s);
  // A window from `first` to `last`, both inside.
  for (std::size_t last = 0; last < rows.size(); ++last) {
    sum += squares[last];
    contact += rows[last].in_contact ? 1 : 0;
    while (rows[last].time_s - rows[first].time_s > length_s) {
      sum -= squares[first];
      contact -= rows[first].in_contact ? 1 : 0;
      ++first;
    }
    // A window that is mostly air has few samples to be judged by.
    const double score = sum / static_cast<double>(std::max(contact, (last - first) / 4 + 1));
    const bool full = first > 0 || rows[last].time_s - rows[first].time_s >= length_s;
    if (!full || score <= worst.score) continue;
    worst.score = score;
    best_first = first;
    best_last = last;
  }
  worst.rows.assign(rows.begin() + static_cast<std::ptrdiff_t>(best_first),
                    rows.begin() + static_cast<std::ptrdiff_t>(best_last + 1));
  return worst;
}

}  // namespace palpate
