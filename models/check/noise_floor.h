// The figures of merit of a perfect model, given the noise of the force sensor. Its error e is normal with the
// standard deviation s of the sensor:
//   within the JND = mean over the samples of P(|e| <= JND(f))
//   99 % error: the q with mean P(|e| <= q JND(f)) = 0.99
// s is identified for each recording, from second differences of the force in the first 30,000 rows, at the 20 %
// quantile of windows of 50 rows (engine/tick/sensor_identification.h). It has white noise, no drift and no hysteresis.
// Thread guarantee: pure function, slow side.
#pragma once

#include <vector>

#include "engine/tick/jnd.h"
#include "models/samples/prepared_recording.h"

namespace palpate {

struct NoiseFloor {
  double force_noise_N = 0.0;  // RMS of s over the samples in contact
  double within_jnd = 1.0;
  double p99_error_over_jnd = 0.0;
};

// Uses the samples in contact of all `recordings`, at most 10,000 rows of each, evenly spaced. Contact begins at the
// estimated surface, and forces count from the estimated force zero.
NoiseFloor noise_floor(const std::vector<const PreparedRecording*>& recordings, const JndLine& jnd);

}  // namespace palpate
