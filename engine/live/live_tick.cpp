#include "engine/live/live_tick.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace palpate {
namespace {

// Domain and bounds of the models are determined for every frame of a window.
constexpr double kAssessed_s = 15.5e-3;
constexpr std::size_t kWarmUpSamples = 500;

static_assert(static_cast<std::uint32_t>(TickFault::bad_sample) == loop_fault::kBadSample &&
              static_cast<std::uint32_t>(TickFault::time_not_later) == loop_fault::kTimeNotLater &&
              static_cast<std::uint32_t>(TickFault::force_not_finite) == loop_fault::kModelNotFinite);

std::uint32_t limiter_faults(std::uint32_t flags) noexcept {
  constexpr std::pair<std::uint32_t, std::uint32_t> kFaultOfFlag[] = {
      {force_limit::kNotFinite, loop_fault::kForceNotFinite},
      {force_limit::kClamped, loop_fault::kForceClamped},
      {force_limit::kSlewed, loop_fault::kForceSlewed},
      {force_limit::kThermal, loop_fault::kForceThermal},
      {force_limit::kStale, loop_fault::kStaleSample}};
  std::uint32_t faults = 0;
  for (const auto& [flag, fault] : kFaultOfFlag) faults |= (flags & flag) != 0 ? fault : 0U;
  return faults;
}

}  // namespace

// At each depth of the strokes, the relaxation of the force is subtracted as a straight line; the first harmonic of the
// rest gives the impedance.
Impedance impedance_of(const std::shared_ptr<const ForceModel>& model) {
  constexpr std::size_t kCycle = ProbingStrokes::kCycleSamples;
  const std::vector<double> forces_N = probed_forces(model).forces_N;
  const double cycle_m = ProbingStrokes(*model).cycle_m();
  const double speed_m_per_s = 2.0 * std::numbers::pi / (kCycle * ProbingStrokes::kStep_s) * cycle_m;
  Impedance largest;
  for (std::size_t place = 0; place < ProbingStrokes::kPlaces; ++place) {
    const double* force_N = &forces_N[place * ProbingStrokes::kPlaceSamples + ProbingStrokes::kRestSamples];
    std::complex<double> harmonic_N;  // the imaginary part is in phase with the position
    for (std::size_t i = 0; i < kCycle; ++i) {
      const double share = static_cast<double>(i) / kCycle;
      const double rest_N = force_N[i] - force_N[0] - share * (force_N[kCycle] - force_N[0]);
      harmonic_N += 2.0 / kCycle * rest_N * std::polar(1.0, 2.0 * std::numbers::pi * share);
    }
    largest.stiffness_N_per_m = std::max(largest.stiffness_N_per_m, harmonic_N.imag() / cycle_m);
    largest.damping_Ns_per_m = std::max(largest.damping_Ns_per_m, harmonic_N.real() / speed_m_per_s);
  }
  return largest;
}

LiveModels::LiveModels(std::uint32_t set_id, const SensorSpec& sensor, const ForceModels& models,
                       std::shared_ptr<ReferenceForce> true_force)
    : id(set_id), tick(sensor, models), reference(std::move(true_force)) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    const Impedance impedance = impedance_of(models[i]);
    stiffness_N_per_m[i] = impedance.stiffness_N_per_m;
    damping_Ns_per_m[i] = impedance.damping_Ns_per_m;
  }
}

LiveTick::LiveTick(Device& device, ModelSlot<LiveModels>& slot, const LiveTickSettings& settings)
    : device_(device),
      slot_(slot),
      mixer_(settings.jnd),
      guard_(device.sensor().encoder_step_m),
      held_(device.holder() == Holder::person),
      limiter_(device.limits()),
      source_(settings.source),
      models_(std::make_unique<LiveModels>(0, device.sensor(), ForceModels{})),
      recorded_(std::make_unique<RecordedRing>()) {}

void LiveTick::warm_up() noexcept {
  update_models();
  HapticsTick& tick = models_->tick;
  tick.reset();
  for (std::size_t i = 0; i < kWarmUpSamples && tick.model_count() > 0; ++i) {
    const ProbingStrokes strokes(tick.model(i * tick.model_count() / kWarmUpSamples));  // each of the models in turn
    ToolSample sample = strokes.at(i * ProbingStrokes::kSamples / kWarmUpSamples);
    sample.time_s = kHapticTick_s * static_cast<double>(i);
    tick.step(sample);
  }
  tick.reset();
}

void LiveTick::update_models() noexcept {
  if (outgoing_ != nullptr || snapshot_.fading) return;  // one fade at a time
  std::unique_ptr<LiveModels> next = slot_.acquire();
  if (next == nullptr) return;
  next->tick.continue_from(models_->tick);
  outgoing_ = std::exchange(models_, std::move(next));
  outgoing_selected_ = snapshot_.selected;
  mixer_.jump_to(ForceMixer::kOutgoing);
  snapshot_.models_id = models_->id;
  if (models_->reference == nullptr) snapshot_.reference_N = kNoForce;
  snapshot_.selected = models_->selected;
  snapshot_.tick = models_->tick.snapshot();
}

void LiveTick::process_samples(double now_s) noexcept {
  snapshot_.samples = 0;
  snapshot_.restarted = false;
  DeviceSample sample;
  for (int i = 0; i < kMaxSamplesPerTick && device_.read(now_s, sample); ++i) process_sample(sample);
  if (snapshot_.samples == 0) return;
  sampled_s_ = now_s;
  if (now_s - assessed_s_ < kAssessed_s && !snapshot_.restarted) return;
  const TickSnapshot& assessed = models_->tick.assess();
  snapshot_.tick.out_of_domain_mask = assessed.out_of_domain_mask;
  snapshot_.tick.predicted_error_N = assessed.predicted_error_N;
  assessed_s_ = now_s;
}

void LiveTick::process_sample(const DeviceSample& sample) noexcept {
  ++snapshot_.samples;
  guard_.acted(sample.force_age);
  snapshot_.restarted = snapshot_.restarted || sample.restart;
  snapshot_.measured_N = sample.measured_N;
  for (LiveModels* set : {outgoing_.get(), models_.get()}) {
    if (set == nullptr) continue;
    if (sample.restart) set->tick.reset();
    set->tick.step(sample.tool);
  }
  snapshot_.tick = models_->tick.snapshot();
  snapshot_.faults |= static_cast<std::uint32_t>(snapshot_.tick.fault);
  if (models_->reference != nullptr && snapshot_.tick.fault != TickFault::bad_sample)
    snapshot_.reference_N = models_->reference->step(snapshot_.tick, sample.restart);
  if (controls_.recording != 0) record(sample);
}

void LiveTick::record(const DeviceSample& sample) noexcept {
  RecordedSample recorded{sample};
  recorded.recording = controls_.recording;
  const TickFault fault = snapshot_.tick.fault;
  recorded.usable = fault != TickFault::bad_sample && fault != TickFault::time_not_later;
  if (models_->reference != nullptr) recorded.reference_N = snapshot_.reference_N;
  if (models_->written_model < models_->tick.model_count())
    recorded.model_N = snapshot_.tick.force_N[models_->written_model];
  recorded_->push(recorded);
}

double LiveTick::mix(double step_s) noexcept {
  const std::size_t count = models_->tick.model_count();
  if (controls_.models_id == models_->id && controls_.selected < count) snapshot_.selected = controls_.selected;
  if (snapshot_.selected >= count) snapshot_.selected = 0;
  ForceMixer::Forces forces_N{};
  std::ranges::copy(snapshot_.tick.force_N, forces_N.begin());
  if (outgoing_ != nullptr) forces_N[ForceMixer::kOutgoing] = outgoing_->tick.snapshot().force_N[outgoing_selected_];
  const double force_N = mixer_.mix(forces_N, snapshot_.selected, step_s);
  snapshot_.fading = !mixer_.settled_on(snapshot_.selected);
  if (outgoing_ != nullptr && !snapshot_.fading) slot_.retire(std::move(outgoing_));
  if (count == 0 && outgoing_ == nullptr) return 0.0;  // without models no damping, either
  const double scaled_N =
      guard_.scaled(force_N, impedance(), controls_.scale, held_, tool(snapshot_.tick.in_contact), {.step_s = step_s});
  snapshot_.stiffness_share = static_cast<float>(guard_.stiffness_share());
  snapshot_.delay_ms = static_cast<float>(1e3 * guard_.delay_s());
  return scaled_N;
}

// The impedance of the rendered force: a mixture of models during a fade.
Impedance LiveTick::impedance() const noexcept {
  ForceMixer::Forces stiffness = models_->stiffness_N_per_m, damping = models_->damping_Ns_per_m;
  if (outgoing_ != nullptr) {
    stiffness[ForceMixer::kOutgoing] = outgoing_->stiffness_N_per_m[outgoing_selected_];
    damping[ForceMixer::kOutgoing] = outgoing_->damping_Ns_per_m[outgoing_selected_];
  }
  return {mixer_.current(stiffness), mixer_.current(damping)};
}

ForceGuard::Tool LiveTick::tool(bool in_contact) const noexcept {
  const TickSnapshot& tick = snapshot_.tick;
  return {tick.position_m, tick.velocity_m_per_s, in_contact, snapshot_.fading, snapshot_.samples > 0};
}

bool LiveTick::dead_man_released() const noexcept {
  if (controls_.dead_man == DeadMan::grip) return !snapshot_.device.grip_held;
  return controls_.dead_man == DeadMan::key && !(snapshot_.loop_time_s - controls_.held_s < kDeadManHold_s);
}

void LiveTick::render(double step_s) noexcept {
  snapshot_.passive_N = snapshot_.commanded_N;
  // Off in a study, which presents forces that do not depend on the position of the tool.
  if (source_ == nullptr)
    snapshot_.passive_N = guard_.passive(snapshot_.commanded_N, tool(snapshot_.tick.in_contact && !snapshot_.restarted),
                                         {.step_s = step_s}, snapshot_.rendered_N);
  const DeviceHealth& device = snapshot_.device;
  if (device.faults != 0) snapshot_.faults |= loop_fault::kDeviceFault;
  snapshot_.dead_man_released = dead_man_released();
  // After an impossible sample there is no force until a possible one.
  const bool bad_sample = (snapshot_.faults & loop_fault::kBadSample) != 0;
  const double age_s = std::max(device.sample_age_s, models_->tick.motion_age_s());
  snapshot_.rendered_N =
      limiter_.limit(snapshot_.passive_N, step_s, {age_s, !device.may_push(), snapshot_.dead_man_released, bad_sample});
  snapshot_.faults |= limiter_faults(limiter_.flags());
  snapshot_.limiter_flags = limiter_.flags();
  snapshot_.heat_share = static_cast<float>(limiter_.heat_share());
  device_.write(snapshot_.rendered_N);
}

const LoopSnapshot& LiveTick::run(double now_s, const LoopControls& controls) noexcept {
  const double step_s = started_ ? now_s - snapshot_.loop_time_s : 0.0;
  started_ = true;
  snapshot_.loop_time_s = now_s;
  snapshot_.faults = 0;
  if (controls.acknowledged != controls_.acknowledged) {
    snapshot_.faults_latched = 0;
    snapshot_.device_faults_latched = 0;
  }
  controls_ = controls;
  update_models();
  process_samples(now_s);
  snapshot_.device = device_.health(now_s);
  if (std::isinf(snapshot_.device.sample_age_s)) snapshot_.device.sample_age_s = now_s - sampled_s_;
  snapshot_.commanded_N = source_ != nullptr ? source_->next_force_N(snapshot_.rendered_N) : mix(step_s);
  render(step_s);
  snapshot_.faults_latched |= snapshot_.faults;
  snapshot_.device_faults_latched |= snapshot_.device.faults;
  return snapshot_;
}

}  // namespace palpate
