// Divides the recordings of a report into training and test data, and refuses test data that is also training data.
// Measured forces are compared bit by bit, because sensor noise makes them unique to a recording.
// Thread guarantee: slow side (allocates).
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/samples/samples.h"

namespace palpate {

// The recordings of the paper on a virtual material: 41.499 s with seed 1 for training, 45.272 s with seed 2 for the
// test. `share`: of both durations. Errors: those of record_sensors.
Result<std::vector<PreparedRecordingPointer>> virtual_recordings(const std::string& material, double share = 1.0);

inline bool is_pressed(const RecordingRow& row) { return row.position_m > 0.0; }
inline double largest_force_N(const Recording& recording) {
  return std::ranges::max_element(recording.rows, {}, &RecordingRow::force_N)->force_N;
}

// Training and test data of one fold.
struct Split {
  std::vector<PreparedRecordingPointer> train;
  std::vector<PreparedRecordingPointer> tested;
  double counted_from_s = -1e300;  // earlier samples are replayed because the features have memory, but do not count
  std::string words;               // describes test data that are a part of the training recordings; else empty
};

struct RecordingSet {
  std::vector<Split> folds;                   // one, or several for a cross-validation
  std::vector<PreparedRecordingPointer> all;  // the training recordings come first
  std::size_t trained = 0;                    // number of training recordings; all.size(): each is also a test

  bool is_tested(std::size_t i) const { return i >= trained || trained == all.size(); }
};

// Equal forces in this number of successive rows, kLeakValues (recordings.cpp) different ones or more, are a leak.
inline constexpr std::size_t kLeakRows = 50;

struct SharedStretch {
  std::size_t first_row = 0;    // in `tested`
  std::size_t trained_row = 0;  // in `trained`
  std::size_t rows = 0;         // 0: there is none
};

// The first stretch of `tested` that is found with the forces of a stretch of `trained`. A common stretch of at least
// 2 kLeakRows rows is always found if each kLeakRows successive rows of it have that many different forces.
SharedStretch shared_stretch(const Recording& trained, const Recording& tested);

// Without a training recording, virtual silicone is used: seed 1 for training, seed 2 for the test. Without a test
// recording, the training recordings are divided into up to kMostFolds folds for cross-validation; a single recording
// is divided into training data and a block at its end as the test. Recordings are sorted by name and content.
// Errors: a test recording shares a stretch with a training recording; a test recording without contact; a single
// recording that is too short.
inline constexpr std::size_t kMostFolds = 5;
Result<RecordingSet> split_recordings(std::vector<PreparedRecordingPointer> train,
                                      std::vector<PreparedRecordingPointer> test);

}  // namespace palpate
