#include "devices/virtual/simulated_devices.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/tick/motion_estimator.h"

namespace palpate {
constexpr double kLongestStep_s = 0.02;

// Of the hand.
constexpr double kSubstep_s = 50e-6;  // see HandMotion::move
// The stiffness is not estimated from smaller forces.
constexpr double kLeastForce_N = 0.1;
constexpr double kLearning_s = 0.15;
constexpr double kSoftest_N_per_m = 100.0, kStiffest_N_per_m = 20e3;

// Of the mouse.
constexpr HandSettings kArm;                         // mass, stiffness and damping of the coupling
constexpr double kSmoothingTime_s = 0.015;           // tau: two reports of a mouse at 125 Hz
constexpr double kDriveAcceleration_m_per_s2 = 0.3;  // of the velocity of `drive`: 18 mm/s after 60 ms
// A twentieth of the shortest time constant of the coupling, m / c.
constexpr double kMouseSubstep_s = 250e-6;

SensorSpec SimulatedDevice::sensor() const noexcept {
  return {.position_noise_m = 1e-7, .has_velocity = true, .velocity_noise_m_per_s = 1e-4};
}

bool SimulatedDevice::read(double now_s, DeviceSample& sample) noexcept {
  if (now_s <= now_s_) return false;
  if (now_s > now_s_) advance(std::min(now_s - now_s_, kLongestStep_s), force_N_);
  start_at(now_s);
  sample = {};
  sample.tool.time_s = now_s;
  sample.tool.position_m = position_m();
  sample.tool.velocity_m_per_s = velocity_m_per_s();
  return true;
}

void HandDevice::resume_at(double position_m, double now_s) noexcept {
  HandMotion::resume_at(position_m);
  start_at(now_s);
}

void HandDevice::advance(double gap_s, double force_N) noexcept {
  const int steps = static_cast<int>(std::ceil(gap_s / kSubstep_s));
  for (int i = 0; i < steps; ++i) {
    move(gap_s / steps);
    feel(force_N, gap_s / steps);
  }
  if (!(position_m() > 0.0) || !(force_N > kLeastForce_N)) return;
  has_felt_ = true;
  const double secant_N_per_m = std::clamp(force_N / position_m(), kSoftest_N_per_m, kStiffest_N_per_m);
  stiffness_N_per_m_ += std::min(1.0, gap_s / kLearning_s) * (secant_N_per_m - stiffness_N_per_m_);
}

double HandDevice::held_depth_m(double force_N) const noexcept {
  return std::min(force_N / stiffness_N_per_m_, settings().deepest_m);
}

void MouseDevice::set_target(double position_m, double now_s) noexcept {
  if (!std::isfinite(position_m)) return;
  target_m_.store(std::clamp(position_m, kHighest_m, kDeepest_m), std::memory_order_relaxed);
  last_input_s_.store(now_s, std::memory_order_relaxed);
}

// A tick between the two stores sees the old velocity with the new limit. It is on the other side and stops the target.
void MouseDevice::drive(double velocity_m_per_s, double limit_m, double now_s) noexcept {
  if (!std::isfinite(velocity_m_per_s) || !std::isfinite(limit_m)) return;
  drive_limit_m_.store(std::clamp(limit_m, kHighest_m, kDeepest_m), std::memory_order_relaxed);
  drive_m_per_s_.store(velocity_m_per_s, std::memory_order_relaxed);
  last_input_s_.store(now_s, std::memory_order_relaxed);
}

void MouseDevice::release() noexcept {
  drive_m_per_s_.store(0.0, std::memory_order_relaxed);
  last_input_s_.store(-std::numeric_limits<double>::infinity(), std::memory_order_relaxed);
}

bool MouseDevice::idle(double now_s) const noexcept {
  return drive_m_per_s_.load(std::memory_order_relaxed) == 0.0 &&
         !(now_s - last_input_s_.load(std::memory_order_relaxed) < kIdleTime_s);
}

void MouseDevice::resume_at(double position_m, double velocity_m_per_s, double now_s) noexcept {
  smooth_m_ = position_m_ = position_m;
  velocity_m_per_s_ = velocity_m_per_s;
  // A key moves the tool from where it is; the last target may be far away.
  if (drive_m_per_s_.load(std::memory_order_relaxed) != 0.0) target_m_.store(position_m, std::memory_order_relaxed);
  start_at(now_s);
}

void MouseDevice::move_target(double gap_s) noexcept {
  const double wanted_m_per_s = drive_m_per_s_.load(std::memory_order_relaxed);
  const double most_m_per_s = kDriveAcceleration_m_per_s2 * gap_s;
  target_velocity_m_per_s_ += std::clamp(wanted_m_per_s - target_velocity_m_per_s_, -most_m_per_s, most_m_per_s);
  if (target_velocity_m_per_s_ == 0.0) return;
  const double limit_m = drive_limit_m_.load(std::memory_order_relaxed);
  double from_m = target_m();
  double to_m = from_m + gap_s * target_velocity_m_per_s_;
  if (target_velocity_m_per_s_ > 0.0) {
    // The spring of the hand is stretched in contact, so the target may be deeper than the limit of the tool.
    if (position_m_ >= limit_m) to_m = from_m;
    to_m = std::min(to_m, kDeepest_m);
  } else {
    to_m = std::max(to_m, std::min(from_m, limit_m));
  }
  // A target that the window has set in the meantime is newer and stays.
  target_m_.compare_exchange_strong(from_m, to_m, std::memory_order_relaxed);
}

// Semi-implicit Euler, which is stable for much larger steps with these constants.
void MouseDevice::advance(double gap_s, double force_N) noexcept {
  move_target(gap_s);
  const int steps = static_cast<int>(std::ceil(gap_s / kMouseSubstep_s));
  for (int i = 0; i < steps; ++i) {
    const double step_s = gap_s / steps;
    const double drift_m_per_s = (target_m() - smooth_m_) / kSmoothingTime_s;
    smooth_m_ += drift_m_per_s * step_s;
    const double drive_N = kArm.stiffness_N_per_m * (smooth_m_ - position_m_) +
                           kArm.damping_Ns_per_m * (drift_m_per_s - velocity_m_per_s_);
    velocity_m_per_s_ += step_s * (drive_N - force_N) / kArm.mass_kg;
    position_m_ += step_s * velocity_m_per_s_;
  }
}

// A longer gap between ticks is a stall; the replay advances by this at most.
constexpr double kLongestReplayStep_s = 0.1;

ReplayDevice::ReplayDevice(Recording recording)
    : name_("replay:" + recording.name),
      recording_(std::move(recording)),
      sensor_(identify_sensor(recording_.rows.data(), recording_.rows.size(), recording_.columns)) {}

void ReplayDevice::set_speed(double speed) noexcept {
  if (!std::isfinite(speed)) return;
  speed_.store(std::clamp(speed, kSlowestReplay, kFastestReplay), std::memory_order_relaxed);
}

void ReplayDevice::seek(double at_s) noexcept {
  if (!std::isfinite(at_s)) return;
  seek_s_.store(std::clamp(at_s, 0.0, duration_s()), std::memory_order_relaxed);
}

void ReplayDevice::step(int rows) noexcept {
  pause(true);
  rows_.fetch_add(rows, std::memory_order_relaxed);
}

void ReplayDevice::move_surface(double offset_m) noexcept {
  if (std::isfinite(offset_m)) surface_offset_m_.store(offset_m, std::memory_order_relaxed);
}

void ReplayDevice::go_to(double at_s) noexcept {
  const double time_s = recording_.rows.front().time_s + at_s;
  const auto row = std::lower_bound(recording_.rows.begin(), recording_.rows.end(), time_s,
                                    [](const RecordingRow& a, double time) { return a.time_s < time; });
  next_ = std::min(static_cast<std::size_t>(row - recording_.rows.begin()), recording_.rows.size() - 1);
  // The playhead is at the row exactly, so that the row is read even while paused.
  playhead_s_ = time_of(next_);
  restart_ = true;
}

// `next_` is the row after the one that was read last.
void ReplayDevice::go_by(int rows) noexcept {
  const auto last = static_cast<long>(recording_.rows.size()) - 1;
  const long row = std::clamp(static_cast<long>(next_) - 1 + rows, 0L, last);
  playhead_s_ = time_of(static_cast<std::size_t>(row));
  if (rows < 0) go_to(playhead_s_);
}

void ReplayDevice::move_playhead(double now_s) noexcept {
  const double step_s = started_ ? std::clamp(now_s - now_s_, 0.0, kLongestReplayStep_s) : 0.0;
  started_ = true;
  now_s_ = now_s;
  handed_over_ = 0;
  if (const double offset_m = surface_offset_m(); offset_m != moved_m_) {
    moved_m_ = offset_m;
    go_to(std::min(playhead_s_, duration_s()));
  }
  const double seek_s = seek_s_.exchange(-1.0, std::memory_order_relaxed);
  const int rows = rows_.exchange(0, std::memory_order_relaxed);
  if (seek_s >= 0.0) {
    go_to(seek_s);
  } else if (rows != 0) {
    go_by(rows);
  } else if (!paused()) {
    playhead_s_ += step_s * speed();
    if (next_ == recording_.rows.size()) go_to(0.0);
  }
  shown_s_.store(std::min(playhead_s_, duration_s()), std::memory_order_relaxed);
}

bool ReplayDevice::read(double now_s, DeviceSample& sample) noexcept {
  if (!started_ || now_s > now_s_) move_playhead(now_s);
  if (next_ == recording_.rows.size()) return false;
  const double due_s = time_of(next_);
  if (due_s > playhead_s_) return false;
  // The loop reads no more samples in this tick, so the playhead waits.
  if (++handed_over_ == kMaxSamplesPerTick) playhead_s_ = due_s;
  const RecordingRow& row = recording_.rows[next_];
  sample = {};
  sample.tool = tool_sample(row);
  sample.tool.position_m -= moved_m_;
  sample.measured_N = row.force_N;
  sample.restart = restart_;
  restart_ = false;
  ++next_;
  return true;
}

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
