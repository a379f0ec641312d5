// A paddle that renders a model by itself, at 1 kHz, with no host: the force is that of
// the file which `palpate export --float --c model.c` wrote. Without the hardware:
// standalone.ino gives it a Teensy, the tests give it a simulated motor and time.
//
//   position = (counts - surface_counts) metres_per_count      inside is positive
//   current  = -force mA_per_N, ramped up from 0 over kRamp_us  counts go up inside
//
// There is no current while the grip is not held, and none after a fault of motor or
// encoder, or of the model (a force that is no number), until the grip was let go.
// Thread guarantee: one thread.
#pragma once

#ifndef ARDUINO  // a sketch includes the files of its folder itself
#include "devices/firmware/bridge_protocol.h"
#endif

namespace palpate {
namespace standalone {

// palpate_force_after and palpate_reset of the exported file.
struct ExportedModel {
  float (*force_after)(float step_s, float position_m) = nullptr;
  void (*reset)() = nullptr;
};

struct Settings {
  int32_t surface_counts = 0;
  float metres_per_count = 1e-6F;
  float mA_per_N = 100.0F;
  int16_t most_mA = 1000;
};

// `Board`:
//   uint32_t now_us();                         wraps
//   int32_t counts();
//   uint8_t condition();                       bridge::kMotorFault, kSensorFault, kGrip
//   void set_current_mA(int32_t current_mA);
template <typename Board>
class ModelFirmware {
 public:
  static constexpr uint32_t kPeriod_us = 1000;
  static constexpr uint32_t kRamp_us = 300000;

  ModelFirmware(Board& board, const ExportedModel& model, const Settings& settings)
      : board_(board), model_(model), settings_(settings) {
    board_.set_current_mA(0);
    model_.reset();
    last_us_ = held_since_us_ = board_.now_us();
  }

  // As often as possible; renders once a period and skips what was missed.
  void loop() {
    const uint32_t now_us = board_.now_us();
    const uint32_t step_us = now_us - last_us_;
    if (step_us < kPeriod_us) return;
    if (step_us >= 2 * kPeriod_us) ++missed_;
    last_us_ = now_us;
    render(now_us, static_cast<float>(step_us) * 1e-6F);
  }

  float force_N() const { return force_N_; }
  bool fault() const { return fault_; }
  uint32_t missed() const { return missed_; }  // periods that began late

 private:
  void render(uint32_t now_us, float step_s) {
    const int32_t counts = board_.counts() - settings_.surface_counts;
    // Also while nothing is driven, so that the model's filters know the motion.
    force_N_ = model_.force_after(step_s, static_cast<float>(counts) * settings_.metres_per_count);
    const uint8_t condition = board_.condition();
    const bool held = (condition & bridge::kGrip) != 0;
    if ((condition & (bridge::kMotorFault | bridge::kSensorFault)) != 0 || !(force_N_ - force_N_ == 0.0F))
      fault_ = true;
    if (!held) {
      fault_ = false;
      held_since_us_ = now_us;
    }
    board_.set_current_mA(fault_ || !held ? 0 : current_mA(now_us - held_since_us_));
  }

  int32_t current_mA(uint32_t held_us) {
    if (held_us > kRamp_us) {
      held_us = kRamp_us;
      held_since_us_ = last_us_ - kRamp_us;  // so that the counter may wrap
    }
    const float share = static_cast<float>(held_us) / static_cast<float>(kRamp_us);
    const float commanded_mA = -force_N_ * settings_.mA_per_N * share;
    const auto most_mA = static_cast<float>(settings_.most_mA);
    const float clamped_mA = commanded_mA < -most_mA ? -most_mA : (commanded_mA > most_mA ? most_mA : commanded_mA);
    return static_cast<int32_t>(clamped_mA);
  }

  Board& board_;
  ExportedModel model_;
  Settings settings_;
  uint32_t last_us_ = 0, held_since_us_ = 0, missed_ = 0;
  float force_N_ = 0.0F;
  bool fault_ = false;
};

}  // namespace standalone
}  // namespace palpate
