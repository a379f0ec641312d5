#include "scenes/live/test_part.h"

#include <algorithm>
#include <cstddef>

#include "engine/base/text.h"

namespace palpate {

std::optional<Recording> take_test_part(Recording& recording) {
  constexpr std::ptrdiff_t kLeastRows = 100;
  std::vector<RecordingRow>& rows = recording.rows;
  const auto count = static_cast<std::ptrdiff_t>(rows.size());
  if (count < kLeastRows) return std::nullopt;
  const auto first =
      std::min_element(rows.begin() + count * 6 / 10, rows.begin() + count * 8 / 10,
                       [](const RecordingRow& a, const RecordingRow& b) { return a.force_N < b.force_N; });
  Recording part{recording.name + ", last " + fixed(rows.back().time_s - first->time_s, 1) + " s",
                 recording.columns,
                 {first, rows.end()}};
  rows.erase(first, rows.end());
  return part;
}

}  // namespace palpate
