#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/tick/haptics_tick.h"
#include "scenes/hard/hard.h"

namespace palpate {
constexpr double kPress_s = 0.3, kPulse_s = 0.6, kStill_s = 1.0, kReturn_s = 1.5, kEnd_s = 2.2;
constexpr double kHalfSpan_s = 50e-6;  // half the span of a central difference of a path

Path training_path(int variant) {
  return [variant](double time_s) {
    // Two tones whose sum does not repeat within a minute, compressed so that the tool pauses at the turning points.
    const double pace = variant == 0 ? 1.0 : 0.93;
    const double slow = std::sin(2.0 * std::numbers::pi * 0.41 * pace * time_s + 0.4 * variant);
    const double fast = std::sin(2.0 * std::numbers::pi * 1.37 * pace * time_s);
    const double strokes_m = 0.0025 + 0.0035 * std::tanh(1.4 * (0.75 * slow + 0.45 * fast));
    const double begun = minimum_jerk(0.0, 1.0, 0.4, time_s).aim_m;
    return kInAir_m + begun * (strokes_m - kInAir_m);
  };
}

Path scaled(const Path& path, double factor, double offset_m) {
  return [=](double time_s) { return offset_m + factor * path(time_s); };
}

std::vector<double> even_times(double seconds, double rate_Hz) {
  std::vector<double> times_s;
  for (double i = 0.0; i < seconds * rate_Hz; ++i) times_s.push_back(i / rate_Hz);
  return times_s;
}

Press press_into(Block& block, const Path& path, const std::vector<double>& times_s, const PressSensors& sensors) {
  RandomStream noise(sensors.seed, 0);
  Press press;
  press.recording.name = "press";
  double last_s = times_s.front() - kHalfSpan_s;
  block.reset(path(last_s));
  for (const double time_s : times_s) {
    double position_m = path(time_s);
    const double velocity_m_per_s = (path(time_s + kHalfSpan_s) - path(time_s - kHalfSpan_s)) / (2.0 * kHalfSpan_s);
    const double force_N = block.step(position_m, velocity_m_per_s, time_s - last_s);
    if (sensors.encoder_step_m > 0.0)
      position_m = sensors.encoder_step_m * std::round(position_m / sensors.encoder_step_m);
    press.true_N.push_back(force_N);
    press.recording.rows.push_back({time_s, position_m, force_N + sensors.force_noise_N * noise.normal(), 0.0, 0.0});
    last_s = time_s;
  }
  return press;
}

std::shared_ptr<HardTraining> train_on(Recording recording) {
  const TrainingScene scene{
      "hard case",
      {{FeatureKind::depth, 0.0, {}}, {FeatureKind::velocity, 0.0, {}}, {FeatureKind::lowpass_velocity, 0.17, {}}},
      {}};
  return std::make_shared<HardTraining>(ModelFits({prepare_recording(std::move(recording))}, scene), ModelPlan{});
}

HardFigures measure_press(const Press& press, const std::shared_ptr<const FittedModel>& model) {
  const bool from_air = press.true_N.front() == 0.0;
  HardMeasure measured;
  std::size_t row = 0;
  (void)replay(press.recording, {model}, [&](const RecordingRow& at, const TickSnapshot& snapshot, const HapticsTick&) {
    const double true_N = press.true_N[row++];
    // In contact, for the model or in truth.
    const bool counts = snapshot.in_contact || true_N > 0.0;
    measured.add(snapshot.force_N[0], true_N, counts, from_air ? at.position_m : HardFigures::kNotMeasured);
  });
  return measured.figures();
}

HardFigures measure_hand(const HandTrial& trial, Block& block, const std::shared_ptr<const FittedModel>& model) {
  ClosedLoop loop(trial.settings);
  loop.publish(model);
  const Grip& grip = trial.settings.grip;
  const double aim_m = trial.depth_m + (held(grip) ? trial.force_N / grip.stiffness_N_per_m : 0.0);
  const auto path = [&](double time_s) {
    ClosedLoop::Drive drive;
    if (!held(grip)) {
      drive.push_N = time_s < kReturn_s ? minimum_jerk(0.0, trial.force_N, kPress_s, time_s).aim_m : 0.0;
    } else if (time_s < kReturn_s) {
      drive = minimum_jerk(kInAir_m, aim_m, kPress_s, time_s);
    } else {
      drive = minimum_jerk(aim_m, kInAir_m, kPress_s, time_s - kReturn_s);
    }
    if (time_s >= kPulse_s && time_s < kPulse_s + 0.02) drive.push_N += 1.0;
    return drive;
  };
  HardMeasure measured;
  double still_J = 0.0, given_J = 0.0, exchanged_s = kPress_s;
  bool other = false;
  block.reset(loop.tool().position_m());
  loop.run(kEnd_s, path, [&](const LoopSnapshot& snapshot) {
    const SimulatedTool& tool = loop.tool();
    const double now_s = snapshot.loop_time_s;
    const double true_N = block.step(tool.position_m(), tool.velocity_m_per_s(), kHapticTick_s);
    measured.add(snapshot.rendered_N, true_N, snapshot.tick.in_contact && now_s > kPress_s);
    const double balance_J = tool.energy().balance_J();
    given_J = std::max(given_J, -balance_J);
    if (now_s <= kStill_s) still_J = balance_J;
    if (now_s > kStill_s && now_s <= kReturn_s) given_J = std::max(given_J, still_J - balance_J);
    if (trial.exchange_s > 0.0 && now_s >= exchanged_s + trial.exchange_s) {
      exchanged_s = now_s;
      other = !other;
      loop.publish(other ? trial.other : model);
    }
  });
  HardFigures figures = measured.figures();
  figures.energy_J = (loop.faults() & loop_fault::kStops) == 0 ? given_J : std::numeric_limits<double>::infinity();
  return figures;
}

constexpr double kStepsPerSecond = 1000.0 * static_cast<double>(kPeriodSteps);
constexpr double kStep_s = 1.0 / kStepsPerSecond;

static std::int64_t steps_in(double seconds) { return std::llround(seconds * kStepsPerSecond); }

double SimulatedTool::time_s() const noexcept { return kStep_s * static_cast<double>(step_); }

bool SimulatedTool::read(double now_s, DeviceSample& sample) noexcept {
  if (read_step_ == step_) return false;
  read_step_ = step_;
  // If samples are more frequent than ticks, this is the newest one.
  if (step_ < sample_step_) return false;
  const int waits = ++sample_ % settings_.grouped == 0 ? settings_.grouped : 1;
  sample_step_ = step_ + waits * steps_in(settings_.sample_s) - (settings_.sample_s > 1e-3 ? kPeriodSteps / 2 : 0);
  if (settings_.lost_in > 0 && random_.index(settings_.lost_in) == 0) return false;
  sample = {};
  sample.tool.time_s = now_s;
  const double quantum_m = settings_.encoder_step_m;
  sample.tool.position_m = quantum_m > 0.0 ? quantum_m * std::round(position_m_ / quantum_m) : position_m_;
  sample.force_age = {kStep_s * static_cast<double>(step_ - acting_.sampled),
                      kStep_s * static_cast<double>(step_ - std::exchange(acted_from_, acting_.sampled))};
  newest_sample_ = step_;
  return true;
}

DeviceHealth SimulatedTool::health(double) noexcept { return {.sample_age_s = 0.0, .interval_s = settings_.sample_s}; }

void SimulatedTool::write(double force_N) noexcept {
  if (count_ == written_.size()) return;  // a delay of 10 ms fills less than half
  if (settings_.lost_in > 0 && random_.index(settings_.lost_in) == 0) return;
  const double jitter_s = settings_.jitter_s > 0.0 ? random_.uniform(0.0, settings_.jitter_s) : 0.0;
  std::int64_t due = step_ + steps_in(settings_.delay_s + jitter_s);
  if (count_ > 0) due = std::max(due, written_[(first_ + count_ - 1) % written_.size()].due);
  written_[(first_ + count_++) % written_.size()] = {force_N, newest_sample_, due};
}

// Acceleration is constant within a step, so that the work of the held force is exact
// and the integration adds no energy to a free mass.
void SimulatedTool::advance(double aim_m, double aim_m_per_s, double push_N) noexcept {
  while (count_ > 0 && written_[first_].due <= step_) {
    acting_ = written_[first_];
    first_ = (first_ + 1) % written_.size();
    --count_;
  }
  const Grip& grip = settings_.grip;
  const double drive_N = grip.stiffness_N_per_m * (aim_m - position_m_) +
                         grip.damping_Ns_per_m * (aim_m_per_s - velocity_m_per_s_) + push_N;
  const double before_m_per_s = velocity_m_per_s_;
  velocity_m_per_s_ += kStep_s * (drive_N - acting_.force_N) / grip.mass_kg;
  const double way_m = 0.5 * kStep_s * (before_m_per_s + velocity_m_per_s_);
  position_m_ += way_m;
  const double work_J = acting_.force_N * way_m;
  (work_J > 0.0 ? energy_.put_in_J : energy_.got_out_J) += std::abs(work_J);
  ++step_;
}

void SimulatedTool::place(double position_m, double velocity_m_per_s) noexcept {
  position_m_ = position_m;
  velocity_m_per_s_ = velocity_m_per_s;
}

ClosedLoop::ClosedLoop(const ClosedLoopSettings& settings)
    : tool_(settings), live_(tool_, slot_), uneven_(settings.uneven) {
  controls_.scale = settings.scale;
}

void ClosedLoop::publish(std::shared_ptr<const ForceModel> model) {
  auto set = std::make_unique<LiveModels>(++id_, tool_.sensor(), std::vector{std::move(model)});
  set->tick.recall(history_);
  slot_.publish(std::move(set));
}

void ClosedLoop::run(double seconds, const Path& path, const AfterTick& after_tick) {
  const std::int64_t from = step_;
  const std::int64_t end = step_ + steps_in(seconds);
  for (; step_ < end; ++step_) {
    if (step_ == due_) {
      const LoopSnapshot& snapshot = tick();
      faults_ |= snapshot.faults;
      if (snapshot.samples > 0) history_.add(snapshot.tick, snapshot.restarted);
      deadline_ += kPeriodSteps;
      due_ = uneven_ ? uneven_(deadline_) : deadline_;
      if (after_tick) after_tick(snapshot);
    }
    const Drive drive = path(kStep_s * static_cast<double>(step_ - from));
    tool_.advance(drive.aim_m, drive.aim_m_per_s, drive.push_N);
  }
}

ClosedLoop::Drive minimum_jerk(double from_m, double to_m, double duration_s, double time_s) {
  const double u = std::clamp(time_s / duration_s, 0.0, 1.0);
  const double way_m = to_m - from_m;
  return {from_m + way_m * u * u * u * (10.0 + u * (6.0 * u - 15.0)),
          way_m * 30.0 * u * u * (1.0 - u) * (1.0 - u) / duration_s, 0.0};
}

}  // namespace palpate
