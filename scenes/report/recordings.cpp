#include "scenes/report/measure.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "engine/base/text.h"
#include "engine/recording/recording.h"
#include "scenes/material/rig.h"

namespace palpate {
namespace {

constexpr std::size_t kLeakValues = 12;
constexpr std::size_t kSmallestRecording = 1000;  // rows; a shorter recording is not divided

// Each recording is tested once, with models that are fitted to the other folds.
std::vector<Split> folds_of(const std::vector<PreparedRecordingPointer>& all) {
  std::vector<Split> folds(std::min(kMostFolds, all.size()));
  for (Split& fold : folds) fold.words = std::to_string(folds.size()) + "-fold cross-validation over the training";
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t f = 0; f < folds.size(); ++f)
      (i % folds.size() == f ? folds[f].tested : folds[f].train).push_back(all[i]);
  }
  return folds;
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

// Whether the window has so many different forces that two recordings cannot have it in common by chance.
bool is_telling(const Forces& forces_N, std::size_t first) {
  const auto begin = forces_N.begin() + static_cast<std::ptrdiff_t>(first);
  return std::set<double>(begin, begin + static_cast<std::ptrdiff_t>(kLeakRows)).size() >= kLeakValues;
}

// The longest stretch of equal forces that contains these rows.
SharedStretch extended(const Forces& trained, const Forces& tested, std::size_t trained_row, std::size_t tested_row) {
  const auto known = trained.begin() + static_cast<std::ptrdiff_t>(trained_row);
  const auto asked = tested.begin() + static_cast<std::ptrdiff_t>(tested_row);
  const std::reverse_iterator before(known);
  const auto first = std::mismatch(before, trained.rend(), std::reverse_iterator(asked), tested.rend()).first.base();
  const auto last = std::mismatch(known, trained.end(), asked, tested.end()).first;
  const auto back = static_cast<std::size_t>(known - first);
  return {tested_row - back, trained_row - back, static_cast<std::size_t>(last - first)};
}

// A time of a recording, counted from its beginning.
std::string seconds(const Recording& recording, std::size_t row) {
  return three_digits(recording.rows[row].time_s - recording.rows.front().time_s);
}

// Splits off a block of up to 40 % at the end of a recording as test data (first_test_row). A recording of fewer than
// 1000 rows gives an empty split.
Split leave_out(const PreparedRecordingPointer& training) {
  Split split;
  const Recording& whole = training->recording;
  if (whole.rows.size() < kSmallestRecording) return split;
  const auto cut = whole.rows.begin() + static_cast<std::ptrdiff_t>(first_test_row(whole));
  split.train.push_back(prepare_recording({whole.name, whole.columns, {whole.rows.begin(), cut}}));
  split.tested.push_back(training);
  split.counted_from_s = cut->time_s;
  split.words = "a block at the end of the training recording, " +
                std::to_string(100 - 100 * split.train[0]->recording.rows.size() / whole.rows.size()) +
                " % of it, left out of these fits";
  return split;
}

// The first `trained` recordings of `all` are training data, the others test data; without others, all pairs are
// compared.
Status refuse_leakage(const std::vector<PreparedRecordingPointer>& all, std::size_t trained) {
  const bool tests = trained < all.size();
  for (std::size_t i = tests ? trained : 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < (tests ? trained : i); ++k) {
      const Recording& trained_on = all[k]->recording;
      const Recording& tested = all[i]->recording;
      const SharedStretch stretch = shared_stretch(trained_on, tested);
      if (stretch.rows == 0) continue;
      return Error{tested.name + ": the forces of " + std::to_string(stretch.rows) + " rows from " +
                   seconds(tested, stretch.first_row) + " s on are those of " + trained_on.name + " from " +
                   seconds(trained_on, stretch.trained_row) +
                   " s on, expected a test that was not trained on; leave that stretch out of one of them"};
    }
  }
  return {};
}

}  // namespace

Result<std::vector<PreparedRecordingPointer>> virtual_recordings(const std::string& material, double share) {
  std::vector<PreparedRecordingPointer> made;
  for (const double seconds : {41.499, 45.272}) {
    auto recording = record_sensors({material, made.size() + 1, share * seconds});
    if (!recording) return recording.error();
    made.push_back(prepare_recording(std::move(*recording)));
  }
  return made;
}

SharedStretch shared_stretch(const Recording& trained, const Recording& tested) {
  const Forces known = forces_of(trained);
  const Forces asked = forces_of(tested);
  // Compares every kLeakRows-th window of the first with all windows of the second.
  std::unordered_map<std::string_view, std::size_t> windows;
  for (std::size_t first = 0; first + kLeakRows <= known.size(); first += kLeakRows) {
    if (is_telling(known, first)) windows.try_emplace(window_at(known, first), first);
  }
  for (std::size_t first = 0; first + kLeakRows <= asked.size(); ++first) {
    const auto found = windows.find(window_at(asked, first));
    if (found != windows.end()) return extended(known, asked, found->second, first);
  }
  return {};
}

Result<RecordingSet> split_recordings(std::vector<PreparedRecordingPointer> train,
                                      std::vector<PreparedRecordingPointer> test) {
  RecordingSet set;
  const bool is_virtual = train.empty();
  // The result does not depend on the order in which the recordings are given.
  for (auto* recordings : {&train, &test}) {
    std::ranges::sort(*recordings, {}, [](const PreparedRecordingPointer& one) {
      return std::tie(one->recording.name, one->content_hash);
    });
  }
  std::vector<PreparedRecordingPointer>& all = set.all = std::move(train);
  if (is_virtual) {
    auto made = virtual_recordings("silicone");
    if (!made) return made.error();
    all = std::move(*made);
  }
  set.trained = is_virtual ? 1 : all.size();
  all.insert(all.end(), test.begin(), test.end());
  if (const Status status = refuse_leakage(all, set.trained); !status) return status.error();
  if (set.trained < all.size()) {
    Split& split = set.folds.emplace_back();
    for (std::size_t i = 0; i < all.size(); ++i) (set.is_tested(i) ? split.tested : split.train).push_back(all[i]);
  } else {
    set.folds = all.size() == 1 ? std::vector<Split>{leave_out(all.front())} : folds_of(all);
  }
  if (set.folds.front().tested.empty()) {
    const Recording& only = all.front()->recording;
    return Error{only.name + ": found " + std::to_string(only.rows.size()) +
                 " rows and no test recording, expected at least " + std::to_string(kSmallestRecording) +
                 " to leave a part out; give another recording with --test"};
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!set.is_tested(i) || std::ranges::any_of(all[i]->recording.rows, is_pressed)) continue;
    return Error{all[i]->recording.name +
                 ": no sample is in contact (position_m > 0), expected a press to test on; check the "
                 "sign and zero of position_m"};
  }
  return set;
}

}  // namespace palpate
