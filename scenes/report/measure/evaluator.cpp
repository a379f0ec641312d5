#include "scenes/report/measure/evaluator.h"

#include <algorithm>
#include <utility>

#include "engine/tick/replay.h"

namespace palpate {

Result<std::vector<Evidence>> ReplayEvaluator::evaluate(const Recording& recording,
                                                        const std::vector<ModelPointer>& models,
                                                        const FitControl& control, const Interval& counted) {
  std::vector<Evidence> evidence;
  for (std::size_t first = 0; first < models.size(); first += kMaxModels) {
    if (!control.may_continue(static_cast<double>(first) / static_cast<double>(models.size()))) return interrupted();
    const std::size_t count = std::min(kMaxModels, models.size() - first);
    const auto begin = models.begin() + static_cast<std::ptrdiff_t>(first);
    std::vector<StrokeErrors> here(count, StrokeErrors(jnd_));
    StrokeCounter strokes(recording.rows.back().time_s - recording.rows.front().time_s);
    const auto replayed = replay(
        recording, ForceModels(begin, begin + static_cast<std::ptrdiff_t>(count)),
        [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
          const bool block = strokes.begins_block(row.time_s, snapshot.in_contact);
          if (!snapshot.in_contact || row.time_s < counted.low || row.time_s >= counted.high) return;
          for (std::size_t i = 0; i < count; ++i) {
            const bool outside = (snapshot.out_of_domain_mask >> i & 1U) != 0;
            for (StrokeErrors* errors : {&here[i], &pooled_[first + i]}) {
              if (block) errors->begin_block(strokes.begins_stroke());
              errors->add(snapshot.force_N[i], row.force_N, outside);
            }
          }
        });
    if (!replayed) return replayed.error();
    for (const StrokeErrors& one : here) evidence.push_back(one.evidence());
  }
  return evidence;
}

std::vector<Evidence> ReplayEvaluator::pooled() const {
  std::vector<Evidence> evidence;
  for (const StrokeErrors& one : pooled_) evidence.push_back(one.evidence());
  return evidence;
}

}  // namespace palpate
