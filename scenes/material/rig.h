// The virtual recording rig behind `palpate synth`: a hand presses a block of virtual material, sensors
// write down what they see, and the truth that no sensor sees is kept beside it. Hand and material run at
// 20 kHz whatever the recording's rate, and each sensor draws its noise from a stream of its own: the same
// seed gives the same motion and the same true force at every rate.
// Sensors (per row, independent): encoder, position rounded to its step; force
// cell, white noise, then 12-bit steps over its range; accelerometer (like the
// paper's ADXL330: 280 ug/sqrt(Hz) over 0.5 kHz), white noise and a bias that
// wanders slowly (Ornstein-Uhlenbeck), then 12-bit steps over its range.
// Source: Hoever & Harders (2009), section 2.
// Thread guarantee: one thread at a time; slow side only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/random_stream.h"
#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "scenes/material/hand.h"
#include "scenes/material/material.h"

namespace palpate {

struct SensorSettings {
  double encoder_step_m = 30e-6;
  double force_noise_N = 0.005;
  double force_range_N = 0.0;  // -range .. +range in 4096 steps; clips beyond; 0: as suits the material
  double acceleration_noise_m_per_s2 = 0.07;
  double acceleration_range_m_per_s2 = 40.0;  // -range .. +range in 4096 steps
  double acceleration_bias_m_per_s2 = 0.1;    // standard deviation
  double acceleration_bias_time_s = 20.0;     // how slowly it wanders
  // What real rigs do as well:
  double surface_offset_m = 0.0;  // the recorded position is so much too large
  double force_zero_N = 0.0;      // the recorded force is so much too large
};

inline constexpr double kRigStep_s = 1.0 / 20000.0;
inline constexpr double kSlowestRate_Hz = 10.0;
inline constexpr double kFastestRate_Hz = 20000.0;
// Ten hours at 1 kHz and then some; a recording of this size is 2 GB in memory.
inline constexpr double kMostRows = 5e7;

struct RigSettings {
  std::string material = "silicone";
  std::uint64_t seed = 1;
  double seconds = 0.0;     // 0: the material's own length
  double rate_Hz = 1000.0;  // kSlowestRate_Hz .. kFastestRate_Hz
  SensorSettings sensors;
  std::optional<HandSettings> hand{};  // empty: the hand that suits the material
};

// What really was, at the time of one row.
struct RigTruth {
  double position_m = 0.0;
  double velocity_m_per_s = 0.0;
  double acceleration_m_per_s2 = 0.0;
  double force_N = 0.0;          // of the material, without noise; >= 0
  double surface_depth_m = 0.0;  // more than the depth when the tool has left
};

// Makes rows one by one, in bounded memory.
class Rig {
 public:
  // Errors: unknown material (the message lists the known), seconds negative,
  // not finite or fewer than 10 rows, rate out of range, more than kMostRows.
  static Result<Rig> create(const RigSettings& settings);

  std::size_t row_count() const noexcept { return row_count_; }
  const Material& material() const noexcept { return material_; }

  // The next row and the truth behind it; false after the last.
  bool next(RecordingRow& row, RigTruth& truth) noexcept;

 private:
  Rig(const RigSettings& settings, const Material& material, std::size_t row_count);
  RigTruth truth_now() const noexcept;
  void advance() noexcept;
  RigTruth truth_at(double grid_time) noexcept;

  RigSettings settings_;
  Hand hand_;
  Material material_;
  std::unique_ptr<Block> block_;
  RandomStream force_noise_, acceleration_noise_, bias_noise_;
  std::size_t row_count_ = 0, row_ = 0;
  std::uint64_t grid_index_ = 0;
  RigTruth before_, after_;  // at grid_index_ and one step later
  double bias_m_per_s2_ = 0.0;
};

// A whole recording as the sensors see it, without the truth, named "<material>_<seed>". `progress` is told
// the share done; when it returns false the recording is given up. Errors: as Rig::create; "interrupted".
Result<Recording> record_sensors(const RigSettings& settings, const std::function<bool(double share)>& progress = {});

// What a recording of `row_count` rows made with `settings` says about itself, without path and date.
std::vector<std::string> describe_recording(const RigSettings& settings, const Material& material,
                                            std::size_t row_count);

}  // namespace palpate
