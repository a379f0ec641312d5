#include "scenes/report/recordings.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <map>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "engine/base/text.h"
#include "engine/tick/sensor_identification.h"
#include "models/surface/surface_estimate.h"
#include "scenes/material/rig.h"

namespace palpate {
namespace {

constexpr double kTrainSeconds = 41.499;
constexpr double kTestSeconds = 45.272;
// A part of a recording that is cut for folds is worth testing on from here.
constexpr std::size_t kSmallestPart = 200;

RecordingFacts facts_of(const Recording& recording, const std::string& role) {
  RecordingFacts facts;
  facts.content_hash = hash_text(content_hash(recording));
  facts.role = role;
  facts.name = recording.name;
  facts.samples = recording.rows.size();
  facts.seconds = recording.rows.back().time_s - recording.rows.front().time_s;
  facts.rate_Hz = static_cast<double>(recording.rows.size() - 1) / facts.seconds;
  for (const RecordingRow& row : recording.rows) {
    if (row.position_m <= 0.0) continue;
    ++facts.contact_samples;
    facts.deepest_m = std::max(facts.deepest_m, row.position_m);
    facts.largest_force_N = std::max(facts.largest_force_N, row.force_N);
  }
  facts.force_noise_N =
      identify_force_noise_N(recording.rows.data(), std::min(recording.rows.size(), kSensorIdentificationRows));
  facts.accelerometer = recording.columns.acceleration;
  return facts;
}

void make_folds(RecordingSet& set) {
  const std::size_t folds = std::min(kMostFolds, set.all.size());
  set.folds.resize(folds);
  for (std::size_t i = 0; i < set.all.size(); ++i) {
    for (std::size_t f = 0; f < folds; ++f) (i % folds == f ? set.folds[f].test : set.folds[f].train).push_back(i);
  }
}

Status add_files(RecordingSet& set, const std::vector<std::string>& paths) {
  std::map<std::pair<std::string, std::uint64_t>, SharedRecording> added;
  for (const std::string& path : paths) {
    auto read = read_recording(path);
    if (!read) return read.error();
    const auto recording = std::make_shared<const Recording>(std::move(*read));
    if (!added.try_emplace({recording->name, content_hash(*recording)}, recording).second) {
      return Error{path +
                   " is given twice, expected every recording once: errors on what was trained on say "
                   "nothing; leave one out"};
    }
  }
  for (const auto& [key, recording] : added) set.all.push_back(recording);
  return {};
}

Status add_virtual_silicone(RecordingSet& set, const std::function<bool(double)>& progress) {
  RigSettings settings;
  for (const double seconds : {kTrainSeconds, kTestSeconds}) {
    settings.seconds = seconds;
    settings.seed = set.all.size() + 1;
    auto recording = record_sensors(settings, [&](double share) {
      return !progress || progress(0.5 * (static_cast<double>(set.all.size()) + share));
    });
    if (!recording) return recording.error();
    set.all.push_back(std::make_shared<const Recording>(std::move(*recording)));
  }
  return {};
}

Status check_contact(const RecordingSet& set) {
  for (const RecordingFacts& facts : set.facts) {
    if (facts.role == "train" || facts.contact_samples > 0) continue;
    return Error{facts.name +
                 ": no sample is in contact (position_m > 0), expected a press to test on; check the "
                 "sign and zero of position_m"};
  }
  return {};
}

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

Recording with_correction(const Recording& recording, const RowCorrection& correction) {
  Recording moved = recording;
  for (RecordingRow& row : moved.rows) {
    row.position_m -= correction.offset_m;
    row.force_N -= correction.force_zero_N;
  }
  return moved;
}

std::size_t row_in_air(const Recording& recording, std::size_t from, std::size_t most) {
  const std::size_t end = std::min(recording.rows.size(), from + most);
  for (std::size_t i = from; i < end; ++i) {
    if (recording.rows[i].position_m <= 0.0) return i;
  }
  return from;
}

SharedRecording rows_of(const Recording& recording, std::size_t begin, std::size_t end, const std::string& name) {
  const auto first = recording.rows.begin();
  return std::make_shared<const Recording>(Recording{
      name, recording.columns, {first + static_cast<std::ptrdiff_t>(begin), first + static_cast<std::ptrdiff_t>(end)}});
}

Result<std::vector<SharedRecording>> cut_into_parts(const Recording& whole) {
  const std::size_t part = whole.rows.size() / kMostFolds;
  if (part < kSmallestPart) {
    return Error{whole.name + ": found " + std::to_string(whole.rows.size()) +
                 " rows and no test recording, expected "
                 "at least " +
                 std::to_string(kMostFolds * kSmallestPart) + " to cut into parts; give another recording with --test"};
  }
  std::vector<SharedRecording> parts;
  std::size_t begin = 0;
  for (std::size_t k = 1; k <= kMostFolds; ++k) {
    const std::size_t end = k == kMostFolds ? whole.rows.size() : row_in_air(whole, k * part, part / 2);
    parts.push_back(rows_of(whole, begin, end, whole.name + " part " + std::to_string(k)));
    begin = end;
  }
  return parts;
}

Result<RecordingSet> load_recordings(const std::vector<std::string>& train, const std::vector<std::string>& test,
                                     const std::function<bool(double share)>& progress) {
  if (train.empty() && !test.empty()) {
    return Error{"found --test without --train, expected recordings to train on as well; give them with --train"};
  }
  RecordingSet set;
  set.virtual_recordings = train.empty();
  const Status added = set.virtual_recordings ? add_virtual_silicone(set, progress) : add_files(set, train);
  if (!added) return added.error();
  const std::size_t trained = set.virtual_recordings ? 1 : train.size();
  if (const Status status = add_files(set, test); !status) return status.error();
  if (const Status status = refuse_leakage(set.all, trained); !status) return status.error();
  if (trained == set.all.size()) {
    set.cross_validated = true;
    if (set.all.size() == 1) {
      const SurfaceEstimate surface = estimate_surface(*set.all.front());
      auto parts = cut_into_parts(with_correction(*set.all.front(), {surface.offset_m, surface.force_zero_N}));
      if (!parts) return parts.error();
      set.all = std::move(*parts);
      set.at_own_surface = true;
    }
    make_folds(set);
  } else {
    set.folds.resize(1);
    for (std::size_t i = 0; i < set.all.size(); ++i) {
      (i < trained ? set.folds[0].train : set.folds[0].test).push_back(i);
    }
  }
  for (std::size_t i = 0; i < set.all.size(); ++i) {
    set.facts.push_back(facts_of(*set.all[i], set.cross_validated ? "both" : i < trained ? "train" : "test"));
  }
  if (const Status status = check_contact(set); !status) return status.error();
  return set;
}

}  // namespace palpate
