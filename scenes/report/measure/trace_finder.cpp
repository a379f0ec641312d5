#include "scenes/report/measure/trace_finder.h"

#include <algorithm>

#include "engine/tick/replay.h"

namespace palpate {

Status TraceFinder::search(const Recording& recording, const std::vector<ModelPointer>& models) {
  std::vector<TraceRow> rows;
  std::vector<double> squares;  // per row, summed over the models
  rows.reserve(recording.rows.size());
  const auto replayed = replay(recording, ForceModels(models.begin(), models.end()),
                               [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
                                 TraceRow trace;
                                 trace.time_s = row.time_s;
                                 trace.position_m = row.position_m;
                                 trace.measured_N = row.force_N;
                                 trace.out_of_domain = snapshot.out_of_domain_mask;
                                 trace.in_contact = snapshot.in_contact;
                                 double sum = 0.0;
                                 for (std::size_t i = 0; i < models.size(); ++i) {
                                   trace.force_N.push_back(static_cast<float>(snapshot.force_N[i]));
                                   const double ratio = jnd_.error_over_jnd(snapshot.force_N[i], row.force_N);
                                   if (snapshot.in_contact && counting_[i]) sum += ratio * ratio;
                                 }
                                 rows.push_back(trace);
                                 squares.push_back(sum);
                               });
  if (!replayed) return replayed.error();
  // A window from `first` to `last`, both inside.
  double sum = 0.0;
  std::size_t contact = 0;
  std::size_t first = 0;
  std::size_t best_first = 0;
  std::size_t best_last = 0;
  double best = -1.0;
  const double whole_s = rows.back().time_s - rows.front().time_s;
  for (std::size_t last = 0; last < rows.size(); ++last) {
    sum += squares[last];
    contact += rows[last].in_contact ? 1 : 0;
    while (rows[last].time_s - rows[first].time_s > kTraceSeconds) {
      sum -= squares[first];
      contact -= rows[first].in_contact ? 1 : 0;
      ++first;
    }
    const bool full = first > 0 || (last + 1 == rows.size() && whole_s <= kTraceSeconds);
    // A window that is mostly air has few samples to be judged by.
    const double score = sum / static_cast<double>(std::max(contact, (last - first) / 4 + 1));
    if (full && score > best) {
      best = score;
      best_first = first;
      best_last = last;
    }
  }
  if (best > worst_score_) {
    worst_score_ = best;
    worst_.recording = recording.name;
    worst_.rows.assign(rows.begin() + static_cast<std::ptrdiff_t>(best_first),
                       rows.begin() + static_cast<std::ptrdiff_t>(best_last + 1));
  }
  return {};
}

}  // namespace palpate
