// The table of samples of a training: every row of all recordings, made once. Each estimate of a fit reads its columns;
// nothing reads the recordings again. models/METHOD.md, Samples, defines contact, offsets and folds.
//
// Positions and forces are corrected by the offset of their recording, where that is clear (prepared_recording.h). The
// surface of the table is the median of the clear surfaces, because the next recording is as likely on one side of it
// as on the other. Without one, recordings that press at every position have theirs outside of all positions, and
// recordings that begin under a preload where the line through their first forces is 0. Neighbouring samples of a stroke have correlated errors, so a fold never consists of single samples.
// Thread guarantee: an immutable value; slow side.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/model/fitted_model.h"
#include "models/samples/prepared_recording.h"

namespace palpate {

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
  double rms_velocity_m_per_s = 0.0;
  std::size_t strokes = 0;
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
// The rows that are at least `least_step_s` after the last one of their recording, with the same ranges. The filters of
// the features are exact for steps of any length.
Samples thinned(const Samples& samples, double least_step_s);
// The features at these rows (ascending): one column a row, SI. FeaturePlan advances through all samples, eight
// features at a time. Errors: interrupted.
Result<Eigen::MatrixXd> features_at(const Samples& samples, const std::vector<FeatureSpec>& features,
                                    const std::vector<std::size_t>& rows, const FitControl& control = {});
// Of each recording, in the order of `offsets`, for these features, at most kMaxFeatures.
std::vector<RecordingEnds> recording_ends(const Samples& samples, const std::vector<FeatureSpec>& features);

}  // namespace palpate
