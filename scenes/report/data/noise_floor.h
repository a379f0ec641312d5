// What a perfect model could reach, given the noise of the force sensor: with errors
// that are normal with the sensor's deviation s,
//   within the JND = mean over the samples of P(|e| <= JND(f))
//   99th percentile of error/JND: the q with mean P(|e| <= q JND(f)) = 0.99
// No model can be better on these samples but by luck.
// Thread guarantee: slow side; one thread per object.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/jnd.h"

namespace palpate {

struct NoiseFloor {
  double force_noise_N = 0.0;  // standard deviation, identified from the recording
  double rms_error_N = 0.0;
  double within_jnd = 1.0;
  double p99_error_over_jnd = 0.0;
};

class NoiseFloorFinder {
 public:
  explicit NoiseFloorFinder(const JndLine& jnd) : jnd_(jnd) {}
  // Samples in contact (position_m > 0) of a recording, with its own noise.
  void add(const Recording& recording);
  NoiseFloor result() const;

 private:
  JndLine jnd_;
  // How often noise/JND was what, finely binned by its logarithm.
  std::vector<std::uint64_t> histogram_;
  std::uint64_t samples_ = 0;
  double squares_ = 0.0;
};

}  // namespace palpate
