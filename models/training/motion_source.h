// The training recordings as streams of motion: every pass of a fit over its
// data goes through here, with the estimators that replay and the live loop use.
//
// Each recording has its own sensor (read off its first rows) and its own filter
// state. Recordings are read and estimated once and kept: in memory where they fit,
// longer ones (ten hours at 1 kHz are 36 million rows) in a temporary file
// (spilled_rows.h). Where there is no room for that they are read and estimated again
// in every pass. The rows are the same, bit by bit.
// Thread guarantee: slow side.
#pragma once

#include <cstddef>
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
#include "models/training/spilled_rows.h"

namespace palpate {

// Rows kept in memory, over all recordings together: 216 MB.
inline constexpr std::size_t kMaximumKeptRows = 3000000;

// What is decided from some thousand rows needs no more than these many to take them
// from: a quarter of an hour at 1 kHz.
inline constexpr std::size_t kMaximumSampledRows = 1000000;

// Some 20 ms of reading: a long pass can be stopped at once.
inline constexpr std::size_t kRowsPerQuestion = 65536;

struct MotionRow {
  ToolSample sample;
  MotionEstimate motion;
  double force_N = 0.0;
  int recording = 0;
  int stroke = 0;       // counts contacts, over all recordings
  bool first = false;   // of its recording: filters start anew
  bool run_up = false;  // of a sample (below): filters take it, nothing else does
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
  };

  // `kept_rows`: how many rows may stay in memory between the passes.
  explicit MotionSource(std::vector<Input> inputs, std::size_t kept_rows = kMaximumKeptRows)
      : inputs_(std::move(inputs)), kept_rows_(kept_rows) {}

  // Calls `visit` for every row in order; a visit that returns false ends the
  // pass with "interrupted", and so does `control`, asked every kRowsPerQuestion
  // rows with `fraction`. Errors: those of RecordingReader.
  Status for_each(const std::function<bool(const MotionRow&)>& visit, const FitControl& control = {},
                  double fraction = 0.0);

  // About `most` rows of it, in memory, moved as these are: stretches of every recording,
  // evenly, and as a run-up to each, so that filters remember what was before it, every
  // so-many-th row. After the first pass. Errors: those of `for_each`.
  Result<MotionSource> sample(std::size_t most, const FitControl& control, double fraction);

  // From now on every pass sees its rows moved; one for each recording, in the
  // order of `names`. Contact and strokes follow the moved position.
  void correct(std::vector<RowCorrection> corrections) { corrections_ = std::move(corrections); }

  const std::vector<std::string>& names() const { return names_; }  // after the first pass
  std::size_t rows() const { return rows_; }                        // after the first pass
  // The largest force noise among the recordings; after the first pass.
  double force_noise_N() const { return force_noise_N_; }
  // The coarsest of the recordings' encoder steps, then of their noises; after the first pass.
  double encoder_step_m() const { return encoder_step_m_; }
  double position_noise_m() const { return position_noise_m_; }

 private:
  Status arrange(const FitControl& control, double fraction);
  Status visit_recorded(const std::function<bool(const MotionRow&)>& visit);
  Status read_all(const std::function<bool(const MotionRow&)>& visit);
  bool knows_all() const;
  Status visit_loaded(const std::function<bool(const MotionRow&)>& visit) const;
  Status read_spilled(const std::function<bool(const MotionRow&)>& visit) const;
  void keep(const MotionRow& row);
  void forget();

  std::vector<Input> inputs_;
  std::size_t kept_rows_;
  std::vector<std::string> names_;
  std::vector<MotionRow> kept_;  // as recorded
  std::optional<SpilledRows> spilled_;
  std::vector<std::size_t> first_rows_;  // of the recordings
  bool keeps_ = true;                    // what the first pass reads
  std::vector<RowCorrection> corrections_;
  bool arranged_ = false;
  std::size_t rows_ = 0;
  double force_noise_N_ = 0.0;
  double encoder_step_m_ = 0.0;
  double position_noise_m_ = 0.0;
  bool complete_ = false;  // kept_, spilled_ or the inputs hold everything
};

}  // namespace palpate
