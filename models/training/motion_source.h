// The training recordings as streams of motion estimates. Every pass of a fit over its data uses this class, with the
// estimators of replay and of the live loop.
//
// The sensor of each recording is identified from its first rows, and each recording has its own filter state.
// Recordings are read and estimated once and kept in memory. If they have more than kMaximumRows together, they are
// read again and thinned: the beginning stays, from which the surface is estimated, then evenly spaced stretches, and
// between these every n-th row as a run-up, so that filters keep their memory.
// Thread guarantee: slow side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/recordings/prepared_recording.h"
#include "models/training/cross_validation.h"

namespace palpate {

// Half an hour at 1 kHz, some 144 MB. A fit of some thousand sites gains nothing from more rows.
inline constexpr std::size_t kMaximumRows = 2000000;

// Rows between two calls of FitControl, some 20 ms of reading.
inline constexpr std::size_t kRowsPerQuestion = 65536;

struct MotionRow : SurfaceRow {
  int recording = 0;
  int stroke = 0;       // number of the contact, counted over all recordings
  int fold = 0;         // of the cross-validation (cross_validation.h); 0 before `assign_folds`
  bool first = false;   // of its recording: filters are reset
  bool run_up = false;  // only updates filters, is not a training sample
};

// Subtracted from the rows of one recording; velocity and acceleration stay as they are. With a lag, rows at either end
// for which no force was recorded are dropped.
struct RowCorrection {
  double offset_m = 0.0;
  double force_zero_N = 0.0;
  double lag_s = 0.0;  // the force of a row at t is the force recorded at t + lag_s, interpolated
};

class MotionSource {
 public:
  // One training recording: a file, or rows in memory.
  struct Input {
    std::string path;  // used when `prepared` is null
    PreparedRecordingPointer prepared;
  };

  // `most_rows`: the approximate number of rows to keep in memory.
  explicit MotionSource(std::vector<Input> inputs, std::size_t most_rows = kMaximumRows)
      : inputs_(std::move(inputs)), most_rows_(most_rows) {}

  // Reads the recordings unless they are in memory. Errors: those of RecordingReader; interrupted.
  Status load(const FitControl& control = {}, double fraction = 0.0);

  // Calls `visit` for every kept row in order, the longest recording first. The pass ends with "interrupted" when
  // `visit` returns false or `control`, called every kRowsPerQuestion rows with `fraction`, asks for it.
  // Errors: also those of load.
  Status for_each(const std::function<bool(const MotionRow&)>& visit, const FitControl& control = {},
                  double fraction = 0.0);

  // Sets the corrections of all later passes, one for each of `recordings`. Contact and strokes are
  // determined from the corrected position.
  void correct(std::vector<RowCorrection> corrections) { corrections_ = std::move(corrections); }

  // Assigns the rows of all later passes to the folds of `assignment`.
  void assign_folds(const FoldAssignment& assignment) { assignment_ = assignment; }
  int folds() const { return assignment_ ? assignment_->folds() : 1; }

  struct OneRecording {
    std::string name;
    const PreparedRecording* prepared = nullptr;  // null: a file
    std::size_t recorded = 0;                     // number of rows
    std::uint64_t hash = 0;                       // engine/recording/recording.h
    std::vector<MotionRow> rows;                  // those that are kept, without corrections
  };
  // Valid after the first pass, as all below.
  const std::vector<OneRecording>& recordings() const { return recordings_; }
  // The number of recorded rows, of which about `most_rows` are kept.
  std::size_t rows() const { return rows_; }
  // The largest force noise and encoder step of the recordings, and the position noise of the recording with the
  // largest encoder step.
  double force_noise_N() const { return force_noise_N_; }
  double encoder_step_m() const { return encoder_step_m_; }
  double position_noise_m() const { return position_noise_m_; }

 private:
  // Keeps all rows before `beginning`, then the first `stretch` rows of every `sparse` * `stretch`; of the others
  // every `sparse`-th is kept as a run-up.
  struct Thinning {
    std::size_t beginning = 0;
    std::size_t sparse = 1;
    std::size_t stretch = 1;
    bool is_run_up(std::size_t row) const { return row >= beginning && row % (sparse * stretch) >= stretch; }
  };

  Status read(const Input& input, const Thinning& thinning, OneRecording& one, const FitControl& control,
              double fraction);

  std::vector<Input> inputs_;
  std::size_t most_rows_;
  std::vector<OneRecording> recordings_;  // empty before loading
  std::vector<RowCorrection> corrections_;
  std::optional<FoldAssignment> assignment_;
  std::size_t rows_ = 0;
  double force_noise_N_ = 0.0;
  double encoder_step_m_ = 0.0;
  double position_noise_m_ = 0.0;
};

}  // namespace palpate
