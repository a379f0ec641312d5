// The training recordings as streams of motion: every pass of a fit over its
// data goes through here, with the estimators that replay and the live loop use.
//
// Each recording has its own sensor (read off its first rows) and its own filter state.
// Recordings are read and estimated once and kept in memory, up to kMaximumRows together. Of
// longer ones (ten hours at 1 kHz are 36 million rows) fewer than that are kept: the beginning, from
// which the surface is told, stretches, evenly, and as a run-up to each of these, so that
// filters remember what was before it, every so-many-th row.
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
#include "engine/recording/recording.h"
#include "engine/tick/motion_estimator.h"
#include "engine/tick/tool_sample.h"
#include "models/training/fold_dealer.h"

namespace palpate {

// Half an hour at 1 kHz, 144 MB: more rows tell a fit of some thousand sites nothing new.
inline constexpr std::size_t kMaximumRows = 2000000;

// Some 20 ms of reading: a long pass can be stopped at once.
inline constexpr std::size_t kRowsPerQuestion = 65536;

struct MotionRow {
  ToolSample sample;
  MotionEstimate motion;
  double force_N = 0.0;
  int recording = 0;
  int stroke = 0;       // counts contacts, over all recordings
  int fold = 0;         // of the cross-validation (fold_dealer.h); 0 until folds are dealt
  bool first = false;   // of its recording: filters start anew
  bool run_up = false;  // between the stretches of a long one: filters take it, nothing else does
};

// What is taken off the rows of one recording on their way into training; velocity and
// acceleration stay as they are. With a lag, rows at its end that have no force go.
struct RowCorrection {
  double offset_m = 0.0;
  double force_zero_N = 0.0;
  double lag_s = 0.0;  // the force of a row is what was recorded so much later
};

class MotionSource {
 public:
  // One training recording: a file, or rows in memory.
  struct Input {
    std::string path;  // used when `loaded` is empty
    std::shared_ptr<const Recording> loaded;
    // Of every row of `loaded`, when it is known already.
    std::shared_ptr<const std::vector<MotionEstimate>> motion{};
    // Whether each row of `loaded` is a run-up, for validation by data that were left out; empty: none.
    std::vector<bool> left_out{};
  };

  // `most_rows`: how many stay in memory, about.
  explicit MotionSource(std::vector<Input> inputs, std::size_t most_rows = kMaximumRows)
      : inputs_(std::move(inputs)), most_rows_(most_rows) {}

  // Calls `visit` for every row that is kept, in order, the longest recording first; a visit that
  // returns false ends the pass with "interrupted", and so does `control`, asked every
  // kRowsPerQuestion rows with `fraction`. Errors: those of RecordingReader.
  Status for_each(const std::function<bool(const MotionRow&)>& visit, const FitControl& control = {},
                  double fraction = 0.0);

  // From now on every pass sees its rows moved; one for each recording, in the
  // order of `names`. Contact and strokes follow the moved position.
  void correct(std::vector<RowCorrection> corrections) { corrections_ = std::move(corrections); }
  // And so far further, all of them.
  void shift(double offset_m) {
    for (RowCorrection& one : corrections_) one.offset_m += offset_m;
  }

  // From now on every pass deals its rows to these folds.
  void deal(const FoldDealer& dealer) { dealer_ = dealer; }
  int folds() const { return dealer_ ? dealer_->folds() : 1; }

  // After the first pass.
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<std::uint64_t>& hashes() const { return hashes_; }  // engine/recording/content_hash.h
  // Recorded, of which no more than about `most_rows` are kept.
  std::size_t rows() const { return rows_; }
  // The largest force noise among the recordings, the coarsest of their encoder steps, then of
  // their noises.
  double force_noise_N() const { return force_noise_N_; }
  double encoder_step_m() const { return encoder_step_m_; }
  double position_noise_m() const { return position_noise_m_; }

 private:
  struct OneRecording {
    std::string name;
    std::size_t recorded = 0;
    std::uint64_t hash = 0;       // of its content
    std::vector<MotionRow> rows;  // as recorded
  };
  // Rows up to `beginning`, then the first `stretch` of every `sparse` times as many.
  struct Thinning {
    std::size_t beginning = 0;
    std::size_t sparse = 1;
    std::size_t stretch = 1;
    bool is_run_up(std::size_t row) const { return row >= beginning && row % (sparse * stretch) >= stretch; }
  };

  Status load(const FitControl& control, double fraction);
  Status read(const Input& input, const Thinning& thinning, OneRecording& one, const FitControl& control,
              double fraction);

  std::vector<Input> inputs_;
  std::size_t most_rows_;
  std::vector<std::string> names_;  // none: not loaded yet
  std::vector<std::uint64_t> hashes_;
  std::vector<OneRecording> recordings_;
  std::vector<RowCorrection> corrections_;
  std::optional<FoldDealer> dealer_;
  std::size_t rows_ = 0;
  double force_noise_N_ = 0.0;
  double encoder_step_m_ = 0.0;
  double position_noise_m_ = 0.0;
};

}  // namespace palpate
