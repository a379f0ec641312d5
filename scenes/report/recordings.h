// The recordings of a report and who is trained and tested on which.
//
// Thread guarantee: slow side (does I/O, allocates).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "models/training/motion_source.h"
#include "scenes/report/leakage.h"

namespace palpate {

struct RecordingFacts {
  std::string role;  // train, test, both (k-fold)
  std::string name;
  std::string content_hash;  // of positions and forces, hexadecimal
  std::uint64_t samples = 0;
  std::uint64_t contact_samples = 0;
  double seconds = 0.0;
  double rate_Hz = 0.0;
  double deepest_m = 0.0;
  double largest_force_N = 0.0;
  double force_noise_N = 0.0;  // white, standard deviation
  bool accelerometer = false;
};

// Trained on some recordings, tested on others; indices into RecordingSet::all.
struct Fold {
  std::vector<std::size_t> train;
  std::vector<std::size_t> test;
};

struct RecordingSet {
  std::vector<SharedRecording> all;
  std::vector<Fold> folds;  // one, or k when there is no test recording
  std::vector<RecordingFacts> facts;
  bool virtual_recordings = false;
  bool cross_validated = false;
  bool at_own_surface = false;  // positions are from the surface already: parts of one recording
};

// The same recording with its surface and force zero moved to 0.
Recording with_correction(const Recording& recording, const RowCorrection& correction);

inline constexpr std::size_t kMostFolds = 5;

// The first row from `from` on where the tool is in the air, at most `most` rows further;
// `from` itself when it never is.
std::size_t row_in_air(const Recording& recording, std::size_t from, std::size_t most);

// Rows from `begin` to before `end`, as a recording.
SharedRecording rows_of(const Recording& recording, std::size_t begin, std::size_t end, const std::string& name);

// kMostFolds parts of about the same length, each from a place where the tool is out of
// contact if it ever is. A part says less of its surface than the whole does (it may begin
// on a dent that the last press left): move the whole to its surface before. Errors: too
// short.
Result<std::vector<SharedRecording>> cut_into_parts(const Recording& whole);

// Reads the files. Without any, the virtual silicone: seed 1 to train on, seed 2
// to test on. Without a test recording the training recordings are divided into
// up to kMostFolds folds, each tested by models that were fitted to the others; a
// single one is first cut into kMostFolds parts of about the same length, where the
// tool is out of contact if it ever is. Recordings are ordered by name and content,
// whatever the order in which they were given. Errors: those of the recordings; a test
// recording without a training recording; the same file twice; the same content twice,
// or a stretch of a training recording in a test (leakage.h); no contact in a test
// recording; too short to be cut.
Result<RecordingSet> load_recordings(const std::vector<std::string>& train, const std::vector<std::string>& test,
                                     const std::function<bool(double share)>& progress = {});

}  // namespace palpate
