// The virtual recording rig of `palpate synth`: a simulated hand presses a block of virtual material, and simulated
// sensors record it. Every row comes with the true motion and force. Hand and material are simulated at 20 kHz,
// whatever the rate of the recording, and each sensor has its own random numbers, so that the same seed gives the same
// motion and the same true force at every rate.
// Sensors: the encoder rounds the position to its step; the force sensor adds white noise and has 12 bits over the
// range that suits the material; the accelerometer (like the paper's ADXL330: 280 ug/sqrt(Hz) over 0.5 kHz) adds white
// noise and a bias that drifts slowly (Ornstein-Uhlenbeck process), and has 12 bits over its range.
// Source: Hoever & Harders (2009), section 2.
// Thread guarantee: one thread at a time; slow side only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/random_stream.h"
#include "engine/base/result.h"
#include "engine/recording/recording.h"
#include "scenes/material/material.h"

namespace palpate {

// The simulated hand that presses a known material: it converts a target force to a depth by
// Block::half_relaxed_force_N.
class Hand final : public HandMotion {
 public:
  Hand(const Material& material, const HandSettings& settings, std::uint64_t seed)
      : HandMotion(settings, seed), block_(material.make_block()) {}

 protected:
  double held_depth_m(double force_N) const noexcept override;

 private:
  std::unique_ptr<const Block> block_;  // for half_relaxed_force_N only
};

struct RigSettings {
  std::string material = "silicone";
  std::uint64_t seed = 1;
  double seconds = 0.0;     // 0: the material's default
  double rate_Hz = 1000.0;  // 10 .. 20,000
};

// The true motion and force at the time of one row.
struct RigTruth {
  double position_m = 0.0, velocity_m_per_s = 0.0, acceleration_m_per_s2 = 0.0;
  double force_N = 0.0;  // of the material, without noise; >= 0
};

// Makes rows one at a time, in bounded memory.
class Rig {
 public:
  // Errors: unknown material (lists the known ones), negative or non-finite `seconds`, rate out of range, fewer than
  // 10 or more than 50 million rows.
  static Result<Rig> create(const RigSettings& settings);

  std::size_t row_count() const noexcept { return row_count_; }

  // Sets `row` to the next row and `truth` to its true values. Returns false after the last row.
  bool next(RecordingRow& row, RigTruth& truth) noexcept;

 private:
  Rig(const RigSettings& settings, const Material& material, std::size_t row_count);
  RigTruth truth_now() const noexcept;
  void advance() noexcept;
  RigTruth truth_at(double grid_time) noexcept;

  double rate_Hz_, force_range_N_;
  Hand hand_;
  std::unique_ptr<Block> block_;
  RandomStream force_noise_, acceleration_noise_, bias_noise_;
  std::size_t row_count_ = 0, row_ = 0;
  std::uint64_t grid_index_ = 0;
  RigTruth before_, after_;  // at grid_index_ and one step later
  double bias_m_per_s2_ = 0.0;
};

// A whole recording of the sensors, named "<material>_<seed>". `progress` is called with the share done and may
// return false to interrupt. Errors: as Rig::create; "interrupted".
Result<Recording> record_sensors(const RigSettings& settings, const std::function<bool(double share)>& progress = {});

// The comment lines of a recording of `row_count` rows made with `settings`.
std::vector<std::string> describe_recording(const RigSettings& settings, const Material& material,
                                            std::size_t row_count);

}  // namespace palpate
