// The recordings of a report, who is trained and tested on which, and whether what is tested on
// was trained on: measured forces are compared bit by bit, for sensor noise makes every recording's
// own, whatever its name, its start time or a shift of its positions.
//
// Thread guarantee: slow side (does I/O, allocates).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "models/training/motion_source.h"

namespace palpate {

using SharedRecording = std::shared_ptr<const Recording>;

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

// FNV-1a over positions and forces, row by row. Times and names do not count.
std::uint64_t content_hash(const Recording& recording);
std::string hash_text(std::uint64_t hash);

// A stretch of at least this many rows with the same forces, and this many different
// ones among them, is no chance.
inline constexpr std::size_t kLeakRows = 50;
inline constexpr std::size_t kLeakValues = 12;

struct SharedStretch {
  std::size_t first_row = 0;    // of `tested`
  std::size_t trained_row = 0;  // of `trained`, likewise
  std::size_t rows = 0;
};

// The longest stretch of `tested` whose forces stand in `trained` as well; stretches of
// 2 kLeakRows and more are always found. rows == 0: none.
SharedStretch shared_stretch(const Recording& trained, const Recording& tested);

// `all`: the first `trained` of them to train on, the others to test on. Errors: a recording that
// is given twice under any names, or a stretch of a tested recording that was trained on; by name
// and rows.
Status refuse_leakage(const std::vector<SharedRecording>& all, std::size_t trained);

// Reads the files. Without any, the virtual silicone: seed 1 to train on, seed 2
// to test on. Without a test recording the training recordings are divided into
// up to kMostFolds folds, each tested by models that were fitted to the others; a
// single one is first cut into kMostFolds parts of about the same length, where the
// tool is out of contact if it ever is. Recordings are ordered by name and content,
// whatever the order in which they were given. Errors: those of the recordings; a test
// recording without a training recording; the same file twice; the same content twice,
// or a stretch of a training recording in a test; no contact in a test
// recording; too short to be cut.
Result<RecordingSet> load_recordings(const std::vector<std::string>& train, const std::vector<std::string>& test,
                                     const std::function<bool(double share)>& progress = {});

}  // namespace palpate
