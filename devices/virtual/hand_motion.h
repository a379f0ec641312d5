// The motion of a simulated hand that explores a block: slow presses with dwell, taps, pokes, steps, steady contact
// with slow modulation, rests in the air.
// The target of the hand follows minimum-jerk segments (Flash & Hogan 1985)
//   aim(u) = a + (b - a) (10 u^3 - 15 u^4 + 6 u^5),  u in 0..1,
// plus a tremor of 8 to 12 Hz. The hand is a mass that a spring and a damper couple to the target:
//   m a = k (aim - x) + c (d aim/dt - v) - F
// For a press of F newtons the target is the depth at which the block holds F, plus F / k. A derived class knows that
// depth from the material or estimates it from the force.
// Deterministic: the same seed and forces give the same motion.
// Thread guarantee: one thread at a time; `move` and `feel` are wait-free and allocate nothing.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "engine/base/random_stream.h"

namespace palpate {

struct HandSettings {
  double mass_kg = 0.12;             // finger, handle and tool
  double stiffness_N_per_m = 800.0;  // of the arm, well braced
  double damping_Ns_per_m = 14.0;    // 0.7 of critical in the air
  double tremor_rms_m = 5e-5;
  double strongest_press_N = 6.0;  // largest target force
  double deepest_m = 0.012;        // largest depth that HandDevice assumes for a force
  double fastest_m_per_s = std::numeric_limits<double>::infinity();  // largest speed of the target, without tremor
};

class HandMotion {
 public:
  HandMotion(const HandSettings& settings, std::uint64_t seed);
  virtual ~HandMotion() = default;

  // One step of `dt_s`, at most 50 us for accuracy: `move` computes the new position, then `feel` takes the force
  // there.
  void move(double dt_s) noexcept;
  void feel(double force_N, double dt_s) noexcept;

  double position_m() const noexcept { return position_m_; }
  double velocity_m_per_s() const noexcept { return velocity_m_per_s_; }
  double acceleration_m_per_s2() const noexcept { return acceleration_m_per_s2_; }

  // Continues at rest at `position_m`, returns into the air and begins the next gesture.
  void resume_at(double position_m) noexcept;

 protected:
  // The depth at which the block holds `force_N` after a short press.
  virtual double held_depth_m(double force_N) const noexcept = 0;
  // Whether a force pushes back. If not, the target of a press is the depth alone, which the hand then reaches.
  virtual bool is_pushed_back() const noexcept { return true; }

  const HandSettings& settings() const noexcept { return settings_; }

 private:
  using Gesture = void (HandMotion::*)();  // plans the segments of one gesture
  struct Segment {
    double target_m = 0.0, duration_s = 0.0;
  };
  struct Press {
    double force_N = 0.0, duration_s = 0.0;
  };
  // A tremor component as a rotating vector, which needs no cosine per step.
  struct Tremor {
    std::complex<double> vector_m, turn;  // real part: displacement; `turn`: rotation in one step
    double rate_rad_per_s = 0.0;
  };
  static constexpr std::size_t kMostSegments = 32;

  void plan();
  void slow_press();
  void taps();
  void poke();
  void steps();
  void modulation();
  void rest();
  // The arguments are structs because braces are evaluated from left to right, so that random numbers are drawn in a
  // defined order.
  void go(Segment segment);
  void press(Press press) { go({aim_for(press.force_N), press.duration_s}); }
  void leave(double fastest_s, double slowest_s);
  // A random position in the air, nearer to the block where fastest_m_per_s is small.
  double air(double from_m, double to_m);
  double aim_for(double force_N) const noexcept {
    return held_depth_m(force_N) + (is_pushed_back() ? force_N / settings_.stiffness_N_per_m : 0.0);
  }
  double any(double from, double to) { return random_.uniform(from, to); }
  void advance_aim(double dt_s);

  HandSettings settings_;
  RandomStream random_;
  std::array<Segment, kMostSegments> segments_{};
  std::size_t segment_count_ = 0, segment_ = 0;
  std::array<Gesture, 16> deck_{};  // in random order; shuffled again when all were used
  std::size_t dealt_ = 0;           // number of used gestures
  double segment_from_m_ = 0.0, segment_time_s_ = 0.0, planned_m_ = 0.0;
  double aim_m_ = 0.0, aim_velocity_m_per_s_ = 0.0, tremor_dt_s_ = 0.0;
  std::array<Tremor, 5> tremor_{};
  double position_m_ = 0.0, velocity_m_per_s_ = 0.0, acceleration_m_per_s2_ = 0.0;
};

}  // namespace palpate
