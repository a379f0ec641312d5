// Recordings with the estimates from each alone, and the table of samples of a training. models/METHOD.md, Samples, has
// the equations of free air, force zero, surface, contact, offsets and folds.
//
// Surface and force zero of a recording come from it alone; palpate check reports them, and a fit uses them. The table
// has the rows of all recordings and is made once. Each estimate of a fit reads its columns; nothing reads the
// recordings again. Positions and forces are corrected by the offset of their recording, where that is clear. The
// surface of the table is the median of the clear surfaces, because the next recording is as likely on one side of it
// as on the other. Neighbouring samples of a stroke have correlated errors, so a fold never consists of single samples.
// Thread guarantee: immutable values and pure functions, slow side.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "engine/tick/motion_estimator.h"
#include "engine/tick/tool_sample.h"
#include "models/model/fitted_model.h"
#include "models/samples/selection.h"

namespace palpate {

// The maximum number of rows of a search.
inline constexpr std::size_t kSearchRows = 4000;

// A row of a recording with the estimated motion of the tool.
struct Sample {
  ToolSample tool;
  MotionEstimate motion;  // estimated from every row, before thinning
  double force_N = 0.0;
};

// Every n-th row, n = rows / most + 1 (integer division), so that at most `most` are left, with the motion estimated
// from all.
std::vector<Sample> thinned_rows(const Recording& recording, std::size_t most);
// The smallest and the largest position of at least one row.
std::pair<double, double> position_range_m(const std::vector<Sample>& rows);
// The index of the block of each row: kBlocks blocks of equal path length of the tool.
inline constexpr std::size_t kBlocks = 10;
std::vector<std::size_t> blocks_by_path(const std::vector<Sample>& rows);

inline constexpr double kRestBeforeTouch_s = 5.0;

struct FreeAir {
  bool found = false;
  double inner_end_m = 0.0;  // free air is certain for positions below
  double zero_N = 0.0;
  double zero_error_N = kUnknownError;  // standard error
  double drift_N = 0.0;       // of the zero: median of the last third of the rows in air minus that of the first
  double tool_mass_kg = 0.0;  // mass carried by the force sensor; 0 if not identified
};

struct SurfaceEstimate {
  FreeAir air;  // if not found, all below is unknown
  // To be subtracted from position_m so that 0 is the surface. `raw_offset_m`: the onset, before the test against 0.
  double offset_m = 0.0;
  double raw_offset_m = 0.0;
  double standard_error_m = kUnknownError;  // infinite if the surface is not identified
  double force_zero_N = 0.0;                // to be subtracted from force_N; 0 if not significant
  // The surface at the last touch at rest minus that at the first; the error is infinite with fewer than two.
  double offset_drift_m = 0.0;
  double offset_drift_error_m = kUnknownError;

  bool identified() const { return std::isfinite(standard_error_m); }
};

// The maximum number of rows from which a surface is estimated, and their largest interval: an approach with fewer rows
// does not identify the onset. A longer recording at 1 kHz contributes its first seven minutes.
inline constexpr std::size_t kOnsetRows = 400000;
inline constexpr double kCoarsestOnset_s = 1.5e-3;
// The maximum number of rows of a recording that are kept, 100 minutes at 1 kHz and some 350 MB; of a longer one every
// second, fourth, ...
inline constexpr std::size_t kMostKeptRows = 6000000;

// A recording with the estimates from it alone.
struct PreparedRecording {
  Recording recording;                 // every `stride`-th row
  std::vector<MotionEstimate> motion;  // at these rows, estimated from all
  std::size_t recorded_rows = 0, stride = 1;
  std::uint64_t content_hash = kHashOfNoRows;  // of all rows (engine/recording/recording.h)
  SensorSpec sensor;
  double force_noise_N = 0.0;  // standard deviation
  std::vector<Sample> rows;    // of the beginning, with their motion; at most kOnsetRows
  SurfaceEstimate surface;
};

using PreparedRecordingPointer = std::shared_ptr<const PreparedRecording>;

// The force of free air, the zero of the force of this recording, N; none without free air.
inline std::optional<double> free_air_force_N(const PreparedRecording& prepared) {
  return prepared.surface.air.found ? std::optional(prepared.surface.air.zero_N) : std::nullopt;
}

// `recording`: at least one row.
PreparedRecordingPointer prepare_recording(Recording recording);
// The row at which the test part of a single recording begins, which continues the training part: that with the
// smallest force of the rows from 60 to 80 %, in the air if it is among them, where the material remembers least.
std::size_t first_test_row(const Recording& recording);

// Half an hour at 1 kHz, some 200 MB. A fit of some thousand sites gains nothing from more rows.
inline constexpr std::size_t kMaximumRows = 2000000;

// Rows between two calls of FitControl, some 20 ms of work.
inline constexpr std::size_t kRowsPerQuestion = 65536;

// Surfaces that differ by less count as equal.
inline constexpr double kLeastSurface_m = 0.5 * kWidestSurface_m;

struct Samples {
  // Columns, one value a row; the longest recording first.
  std::vector<Sample> rows;    // positions from the surface of the table, forces without the force zero
  std::vector<int> recording;  // index of `offsets`
  std::vector<int> stroke;     // number of the contact, counted over all recordings; 0 before the first
  std::vector<int> fold;
  int folds = 1;
  // Repetitions, of which one is left out as a whole where the error of a new recording is estimated: the recordings,
  // or the presses of a single one, each from the lowest position before a rise by half of the range.
  std::vector<int> unit;
  int units = 1;

  std::vector<RecordingOffset> offsets;  // one for each recording
  double surface_m = 0.0;                // of the table, in positions as recorded
  std::size_t recorded_rows = 0;         // of all recordings; more than kMaximumRows are thinned evenly
  SensorSpec sensor;                     // the largest encoder step, with the noise of the recording that has it
  double force_noise_N = 0.0;            // the largest of all recordings

  // Ranges in contact.
  std::vector<std::size_t> contact;  // the rows in contact, ascending
  double depth_m = 0.0;              // greatest
  double force_N = 0.0;              // largest
  double always_N = 0.0;             // only one row in a thousand of all has a smaller force
  double lowest_force_N = 0.0;       // below 0 if the material is known to pull (adhesion), else 0
  bool surface_outside = false;      // of all positions, each of which has a force: there is no free air
  double rms_velocity_m_per_s = 0.0;
  double sample_s = 0.0;  // mean sampling period
  double longest_recording_s = 0.0;

  bool begins_recording(std::size_t row) const { return row == 0 || recording[row] != recording[row - 1]; }
  // At or below this magnitude a sample has no measured force, which shows only that the force is not positive. Minus
  // infinity where the material pulls: a force of 0 then counts like any other.
  double no_force_N() const;
};

// `recordings`: at least one. `most_rows`: the number of rows to keep. Errors: no sample in contact; interrupted.
Result<Samples> make_samples(std::vector<PreparedRecordingPointer> recordings, const JndLine& jnd,
                             const FitControl& control = {}, std::size_t most_rows = kMaximumRows);
// The rows in contact of those that are at least `least_step_s` after the last one of their recording. The filters of
// the features are exact for steps of any length.
std::vector<std::size_t> contact_apart(const Samples& samples, double least_step_s);
// The features at these rows (ascending), and the memory of features there, as in RecordingEnds: one column a row, SI.
// Filters of one to eight features advance through all samples, or those that are apart, each on a thread. Errors:
// interrupted.
Result<Eigen::MatrixXd> features_at(const Samples& samples, const std::vector<FeatureSpec>& features,
                                    const std::vector<std::size_t>& rows, const FitControl& control = {});
Result<Eigen::MatrixXd> memory_at(const Samples& samples, const std::vector<FeatureSpec>& features,
                                  const std::vector<std::size_t>& rows, const FitControl& control = {},
                                  double least_step_s = 0.0);
// Of each recording, in the order of `offsets`, for these features, at most kMaxFeatures.
std::vector<RecordingEnds> recording_ends(const Samples& samples, const std::vector<FeatureSpec>& features);

// The one reader of rows for training: finds and removes rows of a recording without information about the material,
// before anything is computed. A test keeps all rows (read_recording), as does a device.
//
// Dropout: up to three consecutive rows with one value outside the range of their neighbours, by more than six times
// the noise, six times the 90 % quantile of such distances, eight times the scatter of the rows next to it (the noise
// at that force), and three times the change of the signal next to it. A position must also imply an acceleration above
// 100 m/s^2; otherwise, and for a force below 100 Hz, three dropouts must have exactly the same value. Fewer than
// three, or more than a tenth of all rows, are not removed.
//
// Held values: the position or the force is slower than the rows, which repeat its last value: it changes by several of
// its steps at once and then not for equal intervals of two rows or more, at any speed. Only the rows with an update
// are kept; at rest, rows at the same intervals. Of two slow channels the slower one determines the rows. Thread
// guarantee: slow side, pure but for read_usable_recording (does I/O).

struct RecordingFaults {
  std::size_t rows = 0;               // number of recorded rows
  std::size_t position_dropouts = 0;  // number of rows
  std::size_t force_dropouts = 0;
  double update_step_s = 0.0;  // interval of the updates of a slow channel; 0: every row has its own values
  bool held_force = false;     // the slow channel is the force, not the position
  std::size_t updates = 0;     // number of rows with an update that were kept

  bool any() const { return position_dropouts + force_dropouts > 0 || update_step_s > 0.0; }
};

// Removes the rows from `recording`. `before`: those of the rows before these, to which they are added.
RecordingFaults remove_faults(Recording& recording, const RecordingFaults& before = {});
// Reads a recording and removes such rows. Errors: those of read_recording.
Result<Recording> read_usable_recording(const std::string& path);
// The same for a training, in blocks of some minutes, of which each is searched for faults by itself, so that memory
// does not grow with the length. `faults`: receives what was removed.
Result<PreparedRecordingPointer> read_prepared_recording(const std::string& path, RecordingFaults& faults);

}  // namespace palpate
