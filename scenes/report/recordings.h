// The recordings of a report, who is trained and tested on which, and whether what is tested on was trained
// on: measured forces are compared bit by bit, for sensor noise makes them every recording's own.
// Thread guarantee: slow side (does I/O, allocates).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"

namespace palpate {

using SharedRecording = std::shared_ptr<const Recording>;

struct RecordingFacts {
  std::string role;  // train, test, both
  std::string name;
  std::string content_hash;  // engine/recording/content_hash.h, hexadecimal
  std::uint64_t samples = 0;
  std::uint64_t contact_samples = 0;
  double seconds = 0.0;
  double rate_Hz = 0.0;
  double deepest_m = 0.0;
  double largest_force_N = 0.0;
  double force_noise_N = 0.0;  // white, standard deviation
  bool accelerometer = false;
};

// What models are fitted to, and what they are tested on then.
struct Split {
  std::vector<SharedRecording> train;
  std::vector<SharedRecording> tested;
  double counted_from_s = -1e300;  // what came before is replayed too, for the material remembers
  std::string words;               // what is tested on, where that was left out of the training
};

// Tests a block at the end of a recording, which begins in the air where the tool is there near. Nothing is
// tested where there is too little.
Split leave_out(const SharedRecording& training);

struct RecordingSet {
  std::vector<Split> folds;  // one, or k when there is no test recording
  std::vector<RecordingFacts> facts;
  bool virtual_recordings = false;
};

// A stretch of at least this many rows with the same forces, and this many different
// ones among them, is no chance.
inline constexpr std::size_t kLeakRows = 50;
inline constexpr std::size_t kLeakValues = 12;

struct SharedStretch {
  std::size_t first_row = 0;    // of `tested`
  std::size_t trained_row = 0;  // of `trained`, likewise
  std::size_t rows = 0;
};

// The first stretch of `tested` whose forces stand in `trained` as well; one of 2 kLeakRows
// and more is always found. rows == 0: none.
SharedStretch shared_stretch(const Recording& trained, const Recording& tested);

// `all`: the first `trained` of them to train on, the others to test on; without others each is tested by
// models of the rest. Errors: a stretch of a tested recording that was trained on, or all of it, by name and
// rows.
Status refuse_leakage(const std::vector<SharedRecording>& all, std::size_t trained);

// Without any, the virtual silicone: seed 1 to train on, seed 2 to test on. Without a test
// recording the others are divided into up to kMostFolds folds, each tested by models that were fitted to
// the rest; of a single one a block at its end is left out. Recordings are ordered by name and content.
// Errors: refuse_leakage's; no contact in a test recording; too short to leave a part out.
inline constexpr std::size_t kMostFolds = 5;
Result<RecordingSet> split_recordings(std::vector<SharedRecording> train, std::vector<SharedRecording> test);

}  // namespace palpate
