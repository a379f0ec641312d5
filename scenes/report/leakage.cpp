#include "scenes/report/leakage.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <set>
#include <string_view>
#include <unordered_map>

#include "engine/base/text.h"

namespace palpate {
namespace {

std::uint64_t mixed(std::uint64_t hash, double value) {         // FNV-1a
  const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // -0 is 0
  for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (bits >> (8 * byte) & 0xff)) * 1099511628211ULL;
  return hash;
}

using Forces = std::vector<double>;

Forces forces_of(const Recording& recording) {
  Forces forces_N;
  forces_N.reserve(recording.rows.size());
  for (const RecordingRow& row : recording.rows) forces_N.push_back(row.force_N + 0.0);
  return forces_N;
}

// The bytes of kLeakRows forces from `first` on.
std::string_view window_at(const Forces& forces_N, std::size_t first) {
  return {reinterpret_cast<const char*>(&forces_N[first]), kLeakRows * sizeof(double)};
}

// Enough different forces from `first` on for a coincidence to be out of the question.
bool is_telling(const Forces& forces_N, std::size_t first) {
  const auto begin = forces_N.begin() + static_cast<std::ptrdiff_t>(first);
  return std::set<double>(begin, begin + static_cast<std::ptrdiff_t>(kLeakRows)).size() >= kLeakValues;
}

SharedStretch extended(const Forces& trained, const Forces& tested, std::size_t trained_row, std::size_t tested_row) {
  SharedStretch stretch{tested_row, trained_row, 0};
  while (stretch.first_row > 0 && stretch.trained_row > 0 &&
         tested[stretch.first_row - 1] == trained[stretch.trained_row - 1]) {
    --stretch.first_row;
    --stretch.trained_row;
  }
  while (stretch.first_row + stretch.rows < tested.size() && stretch.trained_row + stretch.rows < trained.size() &&
         tested[stretch.first_row + stretch.rows] == trained[stretch.trained_row + stretch.rows]) {
    ++stretch.rows;
  }
  return stretch;
}

// A time of a recording, counted from its beginning.
std::string seconds(const Recording& recording, std::size_t row) {
  return three_digits(recording.rows[row].time_s - recording.rows.front().time_s);
}

}  // namespace

std::uint64_t content_hash(const Recording& recording) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const RecordingRow& row : recording.rows) hash = mixed(mixed(hash, row.position_m), row.force_N);
  return hash;
}

std::string hash_text(std::uint64_t hash) {
  char text[24];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

SharedStretch shared_stretch(const Recording& trained, const Recording& tested) {
  const Forces known = forces_of(trained);
  const Forces asked = forces_of(tested);
  SharedStretch longest;
  // Every kLeakRows-th window of the one, all windows of the other.
  std::unordered_map<std::string_view, std::size_t> windows;
  for (std::size_t first = 0; first + kLeakRows <= known.size(); first += kLeakRows) {
    if (is_telling(known, first)) windows.try_emplace(window_at(known, first), first);
  }
  for (std::size_t first = 0; first + kLeakRows <= asked.size();) {
    const auto found = windows.find(window_at(asked, first++));
    if (found == windows.end()) continue;
    const SharedStretch stretch = extended(known, asked, found->second, first - 1);
    first = stretch.first_row + stretch.rows;
    if (stretch.rows > longest.rows) longest = stretch;
  }
  return longest;
}

Status refuse_leakage(const std::vector<SharedRecording>& all, std::size_t trained) {
  std::unordered_map<std::uint64_t, const Recording*> seen;
  for (const SharedRecording& recording : all) {
    const auto [at, fresh] = seen.try_emplace(content_hash(*recording), recording.get());
    if (fresh) continue;
    return Error{recording->name + " has the same content as " + at->second->name + " (" + hash_text(at->first) +
                 "), expected every recording once: errors on what was trained on say nothing; leave one out"};
  }
  for (std::size_t i = trained; i < all.size(); ++i) {
    for (std::size_t k = 0; k < trained; ++k) {
      const SharedStretch stretch = shared_stretch(*all[k], *all[i]);
      if (stretch.rows == 0) continue;
      return Error{all[i]->name + ": the forces of " + std::to_string(stretch.rows) + " rows from " +
                   seconds(*all[i], stretch.first_row) + " s on are those of " + all[k]->name + " from " +
                   seconds(*all[k], stretch.trained_row) +
                   " s on, expected a test that was not trained on; leave that stretch out of one of them"};
    }
  }
  return {};
}

}  // namespace palpate
