// The training recordings as streams of motion estimates, and their ranges. Every pass of a fit over its data uses this
// class.
//
// The rows of all recordings are in memory. If they are more than kMaximumRows together, every n-th is kept, with the
// motion that was estimated from all.
// Thread guarantee: slow side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "models/model/fitted_model.h"
#include "models/recordings/prepared_recording.h"
#include "models/training/cross_validation.h"

namespace palpate {

// Half an hour at 1 kHz, some 200 MB. A fit of some thousand sites gains nothing from more rows.
inline constexpr std::size_t kMaximumRows = 2000000;

// Rows between two calls of FitControl, some 20 ms of reading.
inline constexpr std::size_t kRowsPerQuestion = 65536;

struct MotionRow : SurfaceRow {
  int recording = 0;
  int stroke = 0;      // number of the contact, counted over all recordings
  int fold = 0;        // of the cross-validation (cross_validation.h); 0 before `assign_folds`
  bool first = false;  // of its recording: filters are reset
};

class MotionSource {
 public:
  // `recordings`: at least one. `most_rows`: the number of rows to keep in memory.
  explicit MotionSource(std::vector<PreparedRecordingPointer> recordings, std::size_t most_rows = kMaximumRows)
      : inputs_(std::move(recordings)), most_rows_(most_rows) {}

  // Fills the rows unless this was done before. Errors: interrupted.
  Status load(const FitControl& control = {});

  // Calls `visit` for every kept row in order, the longest recording first. `control` is asked every kRowsPerQuestion
  // rows. Errors: interrupted.
  Status for_each(const std::function<void(const MotionRow&)>& visit, const FitControl& control = {});

  // Sets the corrections of all later passes. `surface_m` and the recording's own offset are subtracted from its
  // positions, its force zero from its forces; the force at t becomes the one recorded at t + lag_s, interpolated.
  // Velocity and acceleration stay as they are, and rows for which no force was recorded are dropped. Contact and
  // strokes are determined from the corrected position. `surfaces`: one for each of `recordings`, or none.
  void correct(std::vector<RecordingSurface> surfaces, double surface_m = 0.0) {
    surfaces_ = std::move(surfaces);
    surface_m_ = surface_m;
  }

  // Assigns the rows of all later passes to the folds of `assignment`.
  void assign_folds(const FoldAssignment& assignment) { assignment_ = assignment; }
  int folds() const { return assignment_ ? assignment_->folds() : 1; }

  struct OneRecording {
    std::string name;
    const PreparedRecording* prepared = nullptr;
    std::uint64_t hash = 0;       // engine/recording/recording.h
    std::vector<MotionRow> rows;  // those that are kept, without corrections
  };
  // Valid after `load` or the first pass, as all below.
  const std::vector<OneRecording>& recordings() const { return recordings_; }
  // The number of recorded rows.
  std::size_t rows() const { return rows_; }
  // The largest force noise; the largest encoder step, with the position noise of the recording that has this step.
  double force_noise_N() const { return force_noise_N_; }
  const SensorSpec& sensor() const { return sensor_; }

 private:
  std::vector<PreparedRecordingPointer> inputs_;
  std::size_t most_rows_;
  std::vector<OneRecording> recordings_;  // empty before loading
  std::vector<RecordingSurface> surfaces_;
  double surface_m_ = 0.0;
  std::optional<FoldAssignment> assignment_;
  std::size_t rows_ = 0;
  double force_noise_N_ = 0.0;
  SensorSpec sensor_;
};

// The ranges of the rows.
struct TrainingExtent {
  double depth_m = 0.0;               // greatest
  double force_N = 0.0;               // largest
  double lowest_force_N = 0.0;        // < 0 if the material is known to pull (adhesion), else 0
  double rms_velocity_m_per_s = 0.0;  // in contact
  std::size_t contact_samples = 0;
  std::size_t strokes = 0;
  double loading_path_m = 0.0;    // path of the tool in contact, loading
  double unloading_path_m = 0.0;  // the same, unloading
  double sample_s = 0.0;          // mean sampling period
  double longest_recording_s = 0.0;

  // The folds of cross-validation. With one or two recordings they are strokes or pieces of them.
  FoldAssignment folds(std::size_t recordings) const;
};

// Errors: those of the source; interrupted.
Result<TrainingExtent> measure_extent(MotionSource& source, const JndLine& jnd, const FitControl& control);

// The surface position in m, <= 0, of recordings that begin under a preload at position 0; 0 if there is none or it
// cannot be identified. A straight line is fitted to the samples whose depth is below a hundredth of the greatest; the
// surface is where its force is 0. The line is used if its force at position 0 exceeds the JND and two standard errors,
// its slope exceeds two standard errors, and the surface is nearer than the greatest depth.
// Errors: those of the source; interrupted.
Result<double> find_preload_surface(MotionSource& source, const TrainingExtent& extent, const JndLine& jnd,
                                    const FitControl& control);

}  // namespace palpate
