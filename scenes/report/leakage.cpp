#include "scenes/report/leakage.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <set>
#include <unordered_map>

#include "engine/base/text.h"

namespace palpate {
namespace {

constexpr std::uint64_t kBasis = 14695981039346656037ULL;
constexpr std::uint64_t kPrime = 1099511628211ULL;
constexpr std::uint64_t kBase = 0x9e3779b97f4a7c15ULL;  // of the rolling hash, odd

std::uint64_t mixed(std::uint64_t hash, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value);  // -0 is 0
  for (int byte = 0; byte < 8; ++byte) hash = (hash ^ (bits >> (8 * byte) & 0xff)) * kPrime;
  return hash;
}

std::vector<std::uint64_t> force_hashes(const Recording& recording) {
  std::vector<std::uint64_t> hashes;
  hashes.reserve(recording.rows.size());
  for (const RecordingRow& row : recording.rows) hashes.push_back(mixed(kBasis, row.force_N));
  return hashes;
}

// Enough different forces from `first` on for a coincidence to be out of the question.
bool is_telling(const std::vector<std::uint64_t>& hashes, std::size_t first) {
  const auto begin = hashes.begin() + static_cast<std::ptrdiff_t>(first);
  return std::set<std::uint64_t>(begin, begin + static_cast<std::ptrdiff_t>(kLeakRows)).size() >= kLeakValues;
}

SharedStretch extended(const std::vector<std::uint64_t>& trained, const std::vector<std::uint64_t>& tested,
                       std::size_t trained_row, std::size_t tested_row) {
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
  std::uint64_t hash = kBasis;
  for (const RecordingRow& row : recording.rows) hash = mixed(mixed(hash, row.position_m), row.force_N);
  return hash;
}

std::string hash_text(std::uint64_t hash) {
  char text[24];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

SharedStretch shared_stretch(const Recording& trained, const Recording& tested) {
  const std::vector<std::uint64_t> known = force_hashes(trained);
  const std::vector<std::uint64_t> asked = force_hashes(tested);
  SharedStretch longest;
  if (known.size() < kLeakRows || asked.size() < kLeakRows) return longest;
  // Every kLeakRows-th window of the one, all windows of the other.
  std::unordered_map<std::uint64_t, std::size_t> windows;
  for (std::size_t first = 0; first + kLeakRows <= known.size(); first += kLeakRows) {
    if (!is_telling(known, first)) continue;
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < kLeakRows; ++i) hash = hash * kBase + known[first + i];
    windows.try_emplace(hash, first);
  }
  std::uint64_t oldest = 1;  // kBase^(kLeakRows - 1)
  for (std::size_t i = 1; i < kLeakRows; ++i) oldest *= kBase;
  std::uint64_t rolling = 0;
  std::size_t skip_before = 0;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    if (i >= kLeakRows) rolling -= oldest * asked[i - kLeakRows];
    rolling = rolling * kBase + asked[i];
    if (i + 1 < kLeakRows || i < skip_before) continue;
    const auto found = windows.find(rolling);
    if (found == windows.end()) continue;
    const SharedStretch stretch = extended(known, asked, found->second, i + 1 - kLeakRows);
    if (stretch.rows < kLeakRows) continue;  // two windows with one hash
    skip_before = stretch.first_row + stretch.rows;
    if (stretch.rows > longest.rows) longest = stretch;
  }
  return longest;
}

Status refuse_leakage(const std::vector<const Recording*>& trained, const std::vector<const Recording*>& tested) {
  std::unordered_map<std::uint64_t, const Recording*> seen;
  for (const auto* list : {&trained, &tested}) {
    for (const Recording* recording : *list) {
      const auto [at, fresh] = seen.try_emplace(content_hash(*recording), recording);
      if (fresh) continue;
      return Error{recording->name + " has the same content as " + at->second->name + " (" + hash_text(at->first) +
                   "), expected every recording once: errors on what was trained on say nothing; leave one out"};
    }
  }
  for (const Recording* test : tested) {
    for (const Recording* train : trained) {
      const SharedStretch stretch = shared_stretch(*train, *test);
      if (stretch.rows == 0) continue;
      return Error{test->name + ": the forces of " + std::to_string(stretch.rows) + " rows from " +
                   seconds(*test, stretch.first_row) + " s on are those of " + train->name + " from " +
                   seconds(*train, stretch.trained_row) +
                   " s on, expected a test that was not trained on; leave that stretch out of one of them"};
    }
  }
  return {};
}

}  // namespace palpate
