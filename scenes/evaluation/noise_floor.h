// What a perfect model could reach, given the noise of the force sensor: with errors
// that are normal with the sensor's deviation s,
//   within the JND = mean over the samples of P(|e| <= JND(f))
//   99 % error: the q with mean P(|e| <= q JND(f)) = 0.99
// s is identified from each recording itself: second differences of the force over the quietest fifth of
// its first 30,000 rows (engine/tick/sensor_identification.h): white noise, without drift and hysteresis.
// Thread guarantee: pure function, slow side.
#pragma once

#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"

namespace palpate {

struct NoiseFloor {
  double force_noise_N = 0.0;  // standard deviation, RMS over the samples in contact
  double within_jnd = 1.0;
  double p99_error_over_jnd = 0.0;
};

// Of the samples in contact (position_m > 0) of all `recordings`, each with its own noise.
NoiseFloor noise_floor(const std::vector<const Recording*>& recordings, const JndLine& jnd);

}  // namespace palpate
