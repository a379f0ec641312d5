#include "devices/virtual/simulated_devices.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace palpate {

constexpr double kStart_m = -0.006;
// Duration of the way back from any position of the tool.
constexpr double kReturn_s = 0.8;
// Speed of a usual press; a slower hand stays nearer to the block and trembles less.
constexpr double kUsual_m_per_s = 0.05;
// Ratio of peak speed to mean speed of a minimum-jerk segment.
constexpr double kPeakOverMean = 1.875;

HandMotion::HandMotion(const HandSettings& settings, std::uint64_t seed) : settings_(settings), random_(seed, 0) {
  const std::pair<Gesture, int> times[] = {{&HandMotion::slow_press, 3}, {&HandMotion::taps, 3},
                                           {&HandMotion::poke, 5},       {&HandMotion::steps, 1},
                                           {&HandMotion::modulation, 3}, {&HandMotion::rest, 1}};
  auto next = deck_.begin();
  for (const auto& [gesture, count] : times) next = std::fill_n(next, count, gesture);
  dealt_ = deck_.size();
  const double slowness = std::min(1.0, settings.fastest_m_per_s / kUsual_m_per_s);
  for (Tremor& tremor : tremor_) {
    tremor.rate_rad_per_s = 2.0 * std::numbers::pi * any(8.0, 12.0);
    const double phase_rad = any(-std::numbers::pi, std::numbers::pi);
    const double amplitude_m = slowness * settings.tremor_rms_m * std::sqrt(2.0 / static_cast<double>(tremor_.size()));
    tremor.vector_m = std::polar(amplitude_m, phase_rad);
  }
  position_m_ = segment_from_m_ = planned_m_ = aim_m_ = kStart_m;
  go({kStart_m, any(0.15, 0.4)});
}

void HandMotion::resume_at(double position_m) noexcept {
  position_m_ = segment_from_m_ = planned_m_ = aim_m_ = position_m;
  velocity_m_per_s_ = acceleration_m_per_s2_ = aim_velocity_m_per_s_ = 0.0;
  segment_count_ = segment_ = 0;
  segment_time_s_ = 0.0;
  go({kStart_m, kReturn_s});
}

void HandMotion::move(double dt_s) noexcept {
  position_m_ += dt_s * (velocity_m_per_s_ + 0.5 * dt_s * acceleration_m_per_s2_);
  velocity_m_per_s_ += dt_s * acceleration_m_per_s2_;
  advance_aim(dt_s);
}

// Corrects the velocity that `move` predicted: velocity Verlet.
void HandMotion::feel(double force_N, double dt_s) noexcept {
  const double drive_N = settings_.stiffness_N_per_m * (aim_m_ - position_m_) +
                         settings_.damping_Ns_per_m * (aim_velocity_m_per_s_ - velocity_m_per_s_);
  const double acceleration = (drive_N - force_N) / settings_.mass_kg;
  velocity_m_per_s_ += 0.5 * dt_s * (acceleration - acceleration_m_per_s2_);
  acceleration_m_per_s2_ = acceleration;
}

void HandMotion::advance_aim(double dt_s) {
  segment_time_s_ += dt_s;
  while (segment_time_s_ >= segments_[segment_].duration_s) {
    segment_time_s_ -= segments_[segment_].duration_s;
    segment_from_m_ = segments_[segment_].target_m;
    if (++segment_ == segment_count_) plan();
  }
  const Segment& segment = segments_[segment_];
  const double u = segment_time_s_ / segment.duration_s;
  const double distance_m = segment.target_m - segment_from_m_;
  aim_m_ = segment_from_m_ + distance_m * u * u * u * (10.0 + u * (6.0 * u - 15.0));
  aim_velocity_m_per_s_ = distance_m / segment.duration_s * 30.0 * u * u * (1.0 - u) * (1.0 - u);
  for (Tremor& tremor : tremor_) {
    if (dt_s != tremor_dt_s_) tremor.turn = std::polar(1.0, tremor.rate_rad_per_s * dt_s);
    tremor.vector_m *= tremor.turn;
    aim_m_ += tremor.vector_m.real();
    aim_velocity_m_per_s_ -= tremor.rate_rad_per_s * tremor.vector_m.imag();
  }
  tremor_dt_s_ = dt_s;
}

void HandMotion::go(Segment segment) {
  if (segment_count_ == kMostSegments) return;
  segment.duration_s =
      std::max(segment.duration_s, kPeakOverMean * std::abs(segment.target_m - planned_m_) / settings_.fastest_m_per_s);
  segments_[segment_count_++] = segment;
  planned_m_ = segment.target_m;
}

// Draws gestures in random order without replacement, so that every half minute has all of them.
void HandMotion::plan() {
  segment_count_ = segment_ = 0;
  if (dealt_ == deck_.size()) {
    for (std::size_t i = deck_.size() - 1; i > 0; --i) std::swap(deck_[i], deck_[random_.index(i + 1)]);
    dealt_ = 0;
  }
  (this->*deck_[dealt_++])();
}

double HandMotion::air(double from_m, double to_m) {
  return any(from_m, to_m) * std::min(1.0, settings_.fastest_m_per_s / kUsual_m_per_s);
}

// Moves back into the air, then pauses briefly.
void HandMotion::leave(double fastest_s, double slowest_s) {
  const double air_m = air(-0.006, -0.001);
  go({air_m, any(fastest_s, slowest_s)});
  go({air_m, any(0.03, 0.15)});
}

void HandMotion::slow_press() {
  press({any(0.5, 1.0) * settings_.strongest_press_N, any(0.35, 0.9)});
  go({planned_m_, any(0.1, 0.6)});
  if (any(0.0, 1.0) < 0.4) {
    press({any(0.1, 0.6) * settings_.strongest_press_N, any(0.2, 0.5)});
    go({planned_m_, any(0.1, 0.4)});
  }
  leave(0.2, 0.7);
}

void HandMotion::taps() {
  const std::uint64_t count = 5 + random_.index(6);
  for (std::uint64_t i = 0; i < count; ++i) {
    press({any(0.2, 0.85) * settings_.strongest_press_N, any(0.1, 0.18)});
    go({air(-0.003, -0.001), any(0.08, 0.18)});
  }
}

void HandMotion::poke() {
  press({any(0.5, 0.95) * settings_.strongest_press_N, any(0.1, 0.2)});
  go({planned_m_, any(0.02, 0.4)});
  leave(0.08, 0.25);
}

void HandMotion::steps() {
  const std::uint64_t count = 3 + random_.index(4);
  for (std::uint64_t i = 0; i < count; ++i) {
    press({any(0.05, 1.0) * settings_.strongest_press_N, any(0.1, 0.3)});
    go({planned_m_, any(0.1, 0.4)});
  }
  leave(0.15, 0.5);
}

void HandMotion::modulation() {
  const double middle = any(0.4, 0.6);
  const double swing = any(0.2, 0.4);
  press({middle * settings_.strongest_press_N, any(0.3, 0.6)});
  const std::uint64_t count = 5 + random_.index(6);
  for (std::uint64_t i = 0; i < count; ++i) {
    const double side = i % 2 == 0 ? swing : -swing;
    press({(middle + side * any(0.5, 1.0)) * settings_.strongest_press_N, any(0.12, 0.35)});
  }
  leave(0.15, 0.6);
}

void HandMotion::rest() { go({air(-0.010, -0.003), any(0.5, 1.0)}); }

}  // namespace palpate
