// The C interface of models/library/palpate/palpate.h. No exception leaves a function.
#include "models/library/palpate/palpate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/text.h"
#include "engine/json/json_fields.h"
#include "engine/live/device.h"
#include "engine/live/force_guard.h"
#include "engine/live/live_tick.h"
#include "engine/tick/haptics_tick.h"
#include "engine/tick/motion_estimator.h"
#include "models/library/c_interface.h"
#include "models/model/file/model_io.h"

namespace palpate::library {

inline constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// A longer interval counts as this, because a pause is no rate.
inline constexpr double kPause_s = 0.1;

// Compares the steps that a caller names with the times of the samples, over some fifty of them.
class StepCheck {
 public:
  // The step of this call: `given_s`, longer where the samples show that it is. `sample_s`: between the last two
  // samples; 0 without a new one.
  double measured_s(double given_s, double sample_s) noexcept {
    since_sample_s_ += given_s;
    if (sample_s > 0.0) {
      const double counted_s = std::exchange(since_sample_s_, 0.0);
      // A few samples far ahead are wrong samples; many are a clock of another unit.
      ahead_ = sample_s > kPause_s && counted_s < kPause_s ? ahead_ + 1.0 : 0.0;
      if (ahead_ == 0.0 || ahead_ > kFewest) {
        given_s_ = kKeeps * given_s_ + std::min(counted_s, kPause_s);
        by_samples_s_ = kKeeps * by_samples_s_ + std::min(sample_s, kPause_s);
        ++count_;
      }
    }
    return contradict() ? std::clamp(by_samples_s_ / given_s_, 1.0, kLargest) * given_s : given_s;
  }
  bool contradict() const noexcept {
    return count_ >= kFewest && !(by_samples_s_ < kMost * given_s_ && given_s_ < kMost * by_samples_s_);
  }

 private:
  static constexpr double kFewest = 8.0, kKeeps = 0.98, kMost = 1.25, kLargest = 1e6;
  double since_sample_s_ = 0.0, given_s_ = 0.0, by_samples_s_ = 0.0, count_ = 0.0, ahead_ = 0.0;
};

}  // namespace palpate::library

struct palpate_stream {
  palpate_stream(const palpate::SensorSpec& spec, const std::shared_ptr<const palpate::ForceModel>& model)
      : sensor(spec), ticks{{{spec, {model}}, {spec, {model}}}}, impedance(palpate::impedance_of(model)) {}

  palpate::HapticsTick& tick() noexcept { return ticks[current]; }
  const palpate::HapticsTick& tick() const noexcept { return ticks[current]; }
  void reset() noexcept;
  void take(const palpate::ToolSample& sample) noexcept;

  palpate::SensorSpec sensor;
  std::array<palpate::HapticsTick, 2> ticks;  // the current one, and the state before the last jump of the times
  std::size_t current = 0;
  palpate::Impedance impedance;
  bool accepted = false;  // the last sample
  bool restarted = true;  // no sample yet
  double step_s = 0.0;    // to the last accepted sample; 0: it is the first, or the times jumped

 private:
  void look_for_jump(double time_s) noexcept;

  double last_s_ = palpate::library::kNone;         // time of the last accepted sample
  double before_jump_s_ = palpate::library::kNone;  // the same of the state before the last jump
  double jumped_s_ = palpate::library::kNone;       // time after the last jump
  double refused_s_ = palpate::library::kNone;      // of the last sample, if it was refused for its time
};

struct palpate_limiter {
  explicit palpate_limiter(const palpate::ForceLimits& limits) : limiter(limits) {}

  palpate::ForceLimiter limiter;
  bool stop = false;
  // Of palpate_limiter_render.
  palpate::ForceGuard guard{0.0};
  double encoder_step_m = 0.0;  // of `guard`
  double lag_s = 0.0;
  palpate::SampleRate calls, samples;
  double sample_age_s = std::numeric_limits<double>::infinity();
  palpate::library::StepCheck steps;
  bool measures_lag = false;  // from the times of palpate_limiter_acted: for the sample to come, and for the last one
  double acted_from_s = palpate::library::kNone, acted_before_s = palpate::library::kNone;
  unsigned flags = 0;  // beside those of `limiter`
};

void palpate_stream::reset() noexcept {
  for (palpate::HapticsTick& tick : ticks) tick.reset();
  accepted = false;
  restarted = true;
  step_s = 0.0;
  last_s_ = before_jump_s_ = jumped_s_ = refused_s_ = palpate::library::kNone;
}

// A jump of the times may be an error of some stamps, so that the state before it is kept. Where the old times continue
// soon, so does that state. Times that go back are a new stream once two samples agree.
void palpate_stream::look_for_jump(double time_s) noexcept {
  constexpr double kJump_s = 0.1;
  const auto follows = [&](double before_s) { return time_s > before_s && time_s <= before_s + kJump_s; };
  const bool forward = time_s > last_s_ + kJump_s;
  if (!forward && !(time_s < last_s_)) return;
  if (follows(before_jump_s_) && last_s_ <= jumped_s_ + kJump_s) {
    current = 1 - current;
    last_s_ = std::exchange(before_jump_s_, palpate::library::kNone);
  } else if (forward || (time_s < last_s_ - kJump_s && follows(refused_s_))) {
    ticks[1 - current].continue_from(tick());
    before_jump_s_ = last_s_;
    jumped_s_ = time_s;
    if (forward) return;
    tick().reset();
    last_s_ = palpate::library::kNone;
    restarted = true;
  }
}

void palpate_stream::take(const palpate::ToolSample& sample) noexcept {
  if (std::isfinite(sample.time_s) && std::isfinite(sample.position_m)) look_for_jump(sample.time_s);
  const palpate::TickSnapshot& after = tick().step(sample);
  accepted = after.fault != palpate::TickFault::bad_sample && after.fault != palpate::TickFault::time_not_later;
  refused_s_ = after.fault == palpate::TickFault::time_not_later ? sample.time_s : palpate::library::kNone;
  if (!accepted) return;
  step_s = sample.time_s > last_s_ ? sample.time_s - last_s_ : 0.0;
  last_s_ = sample.time_s;
}

namespace palpate::library {
namespace {

// A recording that owns its name and columns.
struct OwnedRecording : palpate_recording {
  explicit OwnedRecording(Recording recording) : palpate_recording{}, owned_name(std::move(recording.name)) {
    name = owned_name.c_str();
    size = recording.rows.size();
    time_s = add(recording, &RecordingRow::time_s);
    position_m = add(recording, &RecordingRow::position_m);
    force_N = add(recording, &RecordingRow::force_N);
    if (recording.columns.velocity) velocity_m_per_s = add(recording, &RecordingRow::velocity_m_per_s);
    if (recording.columns.acceleration) acceleration_m_per_s2 = add(recording, &RecordingRow::acceleration_m_per_s2);
  }

 private:
  const double* add(const Recording& recording, double RecordingRow::*column) {
    std::vector<double>& values = columns.emplace_back();
    for (const RecordingRow& row : recording.rows) values.push_back(row.*column);
    return values.data();
  }

  std::string owned_name;
  std::vector<std::vector<double>> columns;
};

constexpr NumberRange kAbove0{0.0, kLargestNumber, true};

Status check_numbers(std::initializer_list<std::tuple<const char*, double, NumberRange>> numbers) {
  for (const auto& [name, value, range] : numbers) {
    if (!range.holds(value))
      return Error{std::string(name) + ": found " + shortest(value) + ", expected " + range.words()};
  }
  return {};
}

Result<SensorSpec> sensor_spec(const palpate_sensor& sensor) {
  const Status status =
      check_numbers({{"encoder_step_m", sensor.encoder_step_m, kNotNegative},
                     {"position_noise_m", sensor.position_noise_m, kNotNegative},
                     {"velocity_noise_m_per_s", sensor.velocity_noise_m_per_s, kNotNegative},
                     {"acceleration_noise_m_per_s2", sensor.acceleration_noise_m_per_s2, kNotNegative}});
  if (!status) return status.error();
  return SensorSpec{sensor.encoder_step_m,
                    sensor.position_noise_m,
                    sensor.velocity_noise_m_per_s > 0.0,
                    sensor.velocity_noise_m_per_s,
                    sensor.acceleration_noise_m_per_s2 > 0.0,
                    sensor.acceleration_noise_m_per_s2};
}

palpate_sensor sensor_from(const SensorSpec& spec) {
  return {spec.encoder_step_m, spec.position_noise_m, spec.has_velocity ? spec.velocity_noise_m_per_s : 0.0,
          spec.has_acceleration ? spec.acceleration_noise_m_per_s2 : 0.0};
}

Result<ForceLimits> force_limits(const palpate_limits& limits) {
  constexpr NumberRange kEvenInfinite{0.0, HUGE_VAL, true};
  const Status status = check_numbers({{"largest_N", limits.largest_N, kAbove0},
                                       {"fastest_N_per_s", limits.fastest_N_per_s, kAbove0},
                                       {"ramp_s", limits.ramp_s, kNotNegative},
                                       {"continuous_N", limits.continuous_N, kEvenInfinite},
                                       {"thermal_time_s", limits.thermal_time_s, kAbove0},
                                       {"stale_after_s", limits.stale_after_s, kEvenInfinite},
                                       {"stop_s", limits.stop_s, kNotNegative}});
  if (!status) return status.error();
  return std::bit_cast<ForceLimits>(limits);  // the same fields in the same order
}

// Of the force that acted until the sample of this time, as DeviceEndpoint has it. A new command may have replaced the
// one before just before this sample.
ForceAge age_at(palpate_limiter& limiter, double time_s) noexcept {
  constexpr double kLongest_s = 1.0;  // beyond it the times are of another clock
  const double from_s = std::exchange(limiter.acted_from_s, kNone);
  const ForceAge age{time_s - from_s, time_s - std::exchange(limiter.acted_before_s, from_s)};
  return age.least_s >= 0.0 && age.largest_s >= age.least_s && age.largest_s < kLongest_s ? age
                                                                                          : ForceAge{kNone, kNone};
}

// The last force of the stream after the stages of LiveTick. `given_s` >= 0: the step that the caller names.
double render(palpate_limiter& limiter, palpate_stream& stream, double given_s) noexcept {
  const TickSnapshot& tick = stream.tick().snapshot();
  const double step_s = limiter.steps.measured_s(given_s, stream.accepted ? stream.step_s : 0.0);
  if (limiter.encoder_step_m != stream.sensor.encoder_step_m) {
    limiter.encoder_step_m = stream.sensor.encoder_step_m;
    limiter.guard = ForceGuard(limiter.encoder_step_m);
  }
  const bool first = std::isinf(limiter.sample_age_s);
  limiter.sample_age_s += step_s;
  if (!first && step_s > 0.0) limiter.calls.add(std::min(step_s, kPause_s));
  const double tick_s = limiter.calls.interval_s() > 0.0 ? limiter.calls.interval_s() : kHapticTick_s;
  const ForceGuard::Timing timing{step_s, tick_s, limiter.lag_s};
  if (stream.accepted) {
    if (!first && limiter.sample_age_s > 0.0) limiter.samples.add(std::min(limiter.sample_age_s, kPause_s));
    limiter.guard.acted(limiter.measures_lag ? age_at(limiter, tick.time_s) : ForceAge{}, tick_s);
    limiter.sample_age_s = 0.0;
  }
  const bool in_contact = stream.tick().features_of(0).in_contact && !std::exchange(stream.restarted, false);
  const ForceGuard::Tool tool{tick.position_m, tick.velocity_m_per_s, in_contact, false, stream.accepted};
  const double scaled_N = limiter.guard.scaled(tick.force_N[0], stream.impedance, {}, true, tool, timing);
  const double passive_N = limiter.guard.passive(scaled_N, tool, timing, limiter.limiter.force_N());
  const bool stopped = std::exchange(limiter.stop, false) || limiter.calls.too_slow() || limiter.samples.too_slow() ||
                       tick.fault == TickFault::bad_sample;
  limiter.flags = 0;
  if (limiter.guard.stiffness_share() < 0.95) limiter.flags |= PALPATE_LIMIT_REDUCED;
  if (limiter.steps.contradict()) limiter.flags |= PALPATE_LIMIT_WRONG_STEP;
  if (scaled_N - passive_N > JndLine{}.at(scaled_N)) limiter.flags |= PALPATE_LIMIT_PASSIVE;
  const double age_s = std::max(limiter.sample_age_s, stream.tick().motion_age_s());
  return limiter.limiter.limit(passive_N, step_s, {age_s, stopped});
}

}  // namespace
}  // namespace palpate::library

using namespace palpate;
using namespace palpate::library;

int palpate_abi_version(void) { return PALPATE_ABI_VERSION; }

const char* palpate_version(void) { return PALPATE_VERSION; }

palpate_model* palpate_model_load(const char* path, char* error, size_t error_size) {
  return made<palpate_model*>(nullptr, error, error_size, [&]() -> Result<palpate_model*> {
    if (path == nullptr) return Error{"found no path, expected that of a model file"};
    auto model = load_model(path);
    if (!model) return model.error();
    return new palpate_model(std::move(*model));
  });
}

void palpate_model_free(palpate_model* model) { delete model; }

const char* palpate_model_name(const palpate_model* model) {
  return model == nullptr ? "" : model->model->name().c_str();
}

const char* palpate_model_report(const palpate_model* model) { return model == nullptr ? "" : model->report.c_str(); }

int palpate_model_save(const palpate_model* model, const char* path, int overwrite, char* error, size_t error_size) {
  return made<int>(-1, error, error_size, [&]() -> Result<int> {
    if (model == nullptr || path == nullptr) return Error{"found no model or no path, expected both"};
    const Status saved = save_model(path, model->model->data(), overwrite != 0);
    return saved ? Result<int>(0) : saved.error();
  });
}

size_t palpate_model_feature_count(const palpate_model* model) {
  return model == nullptr ? 0 : model->feature_names.size();
}

const char* palpate_model_feature_name(const palpate_model* model, size_t index) {
  return index < palpate_model_feature_count(model) ? model->feature_names[index].c_str() : "";
}

palpate_recording* palpate_recording_load(const char* path, char* error, size_t error_size) {
  return made<palpate_recording*>(nullptr, error, error_size, [&]() -> Result<palpate_recording*> {
    if (path == nullptr) return Error{"found no path, expected that of a recording"};
    auto recording = read_recording(path);
    if (!recording) return recording.error();
    return new OwnedRecording(*recording);
  });
}

void palpate_recording_free(palpate_recording* recording) { delete static_cast<OwnedRecording*>(recording); }

int palpate_in_contact(const palpate_recording* given, unsigned char* in_contact) {
  if (given == nullptr || in_contact == nullptr || given->position_m == nullptr || given->force_N == nullptr) return -1;
  return made<int>(-1, nullptr, 0, [&]() -> Result<int> {
    const Recording recording = recording_of(*given);
    // As in a replay, from the first rows.
    const std::size_t first_rows = std::min(recording.rows.size(), kSensorIdentificationRows);
    const double least_N = least_contact_N(recording.rows.data(), first_rows, 0.0);
    std::ranges::transform(recording.rows, in_contact, [&](const RecordingRow& row) {
      return row.position_m > 0.0 || std::abs(row.force_N) > least_N ? 1 : 0;
    });
    return 0;
  });
}

palpate_stream* palpate_stream_new(const palpate_model* model, double encoder_step_m, char* error, size_t error_size) {
  palpate_sensor sensor{};
  if (model != nullptr) sensor = sensor_from(sensor_with_step(model->model->data(), encoder_step_m));
  return palpate_stream_new_with_sensor(model, &sensor, error, error_size);
}

palpate_stream* palpate_stream_new_with_sensor(const palpate_model* model, const palpate_sensor* sensor, char* error,
                                               size_t error_size) {
  return made<palpate_stream*>(nullptr, error, error_size, [&]() -> Result<palpate_stream*> {
    if (model == nullptr) return Error{"found no model, expected one that palpate_model_load gave"};
    if (sensor == nullptr) return Error{"found no sensor, expected a palpate_sensor"};
    const auto spec = sensor_spec(*sensor);
    if (!spec) return spec.error();
    return new palpate_stream(*spec, model->model);
  });
}

int palpate_sensor_of(const palpate_recording* given, palpate_sensor* sensor) {
  if (given == nullptr || sensor == nullptr || given->position_m == nullptr) return -1;
  return made<int>(-1, nullptr, 0, [&]() -> Result<int> {
    const Recording recording = recording_of(*given);
    *sensor = sensor_from(identify_sensor(recording.rows.data(), recording.rows.size(), recording.columns));
    return 0;
  });
}

int palpate_stream_start_after(palpate_stream* stream, const palpate_recording* before, char* error,
                               size_t error_size) {
  return made<int>(-1, error, error_size, [&]() -> Result<int> {
    if (stream == nullptr || before == nullptr || before->size == 0 || before->time_s == nullptr ||
        before->position_m == nullptr)
      return Error{"found no stream, or no time or position of the recording before it, expected all of them"};
    stream->reset();
    stream->tick().start_after(recording_of(*before));
    return 0;
  });
}

void palpate_stream_free(palpate_stream* stream) { delete stream; }

void palpate_stream_reset(palpate_stream* stream) {
  if (stream != nullptr) stream->reset();
}

double palpate_stream_force(palpate_stream* stream, double time_s, double position_m) {
  return palpate_stream_force_with_motion(stream, time_s, position_m, 0.0, 0.0);
}

double palpate_stream_force_with_motion(palpate_stream* stream, double time_s, double position_m,
                                        double velocity_m_per_s, double acceleration_m_per_s2) {
  if (stream == nullptr) return 0.0;
  stream->take({time_s, position_m, stream->sensor.has_velocity ? velocity_m_per_s : 0.0,
                stream->sensor.has_acceleration ? acceleration_m_per_s2 : 0.0});
  return stream->accepted ? stream->tick().snapshot().force_N[0] : 0.0;
}

int palpate_stream_forces(palpate_stream* stream, size_t n, const double* time_s, const double* position_m,
                          double* force_N, double* bound_N) {
  const palpate_recording motion = {"", n, time_s, position_m, nullptr, nullptr, nullptr};
  return palpate_stream_replay(stream, &motion, force_N, bound_N, nullptr);
}

int palpate_stream_replay(palpate_stream* stream, const palpate_recording* motion, double* force_N, double* bound_N,
                          double* features) {
  if (stream == nullptr || motion == nullptr || motion->time_s == nullptr || motion->position_m == nullptr) return -1;
  const size_t width = stream->tick().model(0).features().size();
  const auto at = [](const double* column, size_t i) { return column == nullptr ? 0.0 : column[i]; };
  for (size_t i = 0; i < motion->size; ++i) {
    const double force =
        palpate_stream_force_with_motion(stream, motion->time_s[i], motion->position_m[i],
                                         at(motion->velocity_m_per_s, i), at(motion->acceleration_m_per_s2, i));
    if (force_N != nullptr) force_N[i] = force;
    if (bound_N != nullptr) bound_N[i] = palpate_stream_predicted_error(stream);
    if (features != nullptr) std::copy_n(stream->tick().features_of(0).values.data(), width, features + i * width);
  }
  return 0;
}

int palpate_stream_accepted(const palpate_stream* stream) { return stream != nullptr && stream->accepted ? 1 : 0; }

int palpate_stream_out_of_domain(const palpate_stream* stream) {
  return stream != nullptr && stream->tick().assessed(0).out_of_domain ? 1 : 0;
}

double palpate_stream_predicted_error(const palpate_stream* stream) {
  return stream == nullptr ? kNone : stream->tick().assessed(0).predicted_error_N;
}

void palpate_limits_default(palpate_limits* limits) {
  if (limits != nullptr) *limits = std::bit_cast<palpate_limits>(ForceLimits{});
}

palpate_limiter* palpate_limiter_new(const palpate_limits* limits, char* error, size_t error_size) {
  return made<palpate_limiter*>(nullptr, error, error_size, [&]() -> Result<palpate_limiter*> {
    palpate_limits chosen;
    palpate_limits_default(&chosen);
    if (limits != nullptr) chosen = *limits;
    const auto checked = force_limits(chosen);
    if (!checked) return checked.error();
    return new palpate_limiter(*checked);
  });
}

void palpate_limiter_free(palpate_limiter* limiter) { delete limiter; }

double palpate_limiter_force(palpate_limiter* limiter, double commanded_N, double step_s, double sample_age_s) {
  if (limiter == nullptr) return 0.0;
  limiter->flags = 0;
  return limiter->limiter.limit(commanded_N, step_s, {sample_age_s, std::exchange(limiter->stop, false)});
}

double palpate_limiter_render(palpate_limiter* limiter, palpate_stream* stream, double time_s, double position_m,
                              double step_s) {
  if (limiter == nullptr || stream == nullptr) return 0.0;
  palpate_stream_force(stream, time_s, position_m);
  return render(*limiter, *stream, std::isfinite(step_s) ? std::max(0.0, step_s) : 0.0);
}

int palpate_limiter_set_lag(palpate_limiter* limiter, double lag_s) {
  if (limiter == nullptr || !std::isfinite(lag_s) || lag_s < 0.0) return -1;
  limiter->lag_s = lag_s;
  return 0;
}

void palpate_limiter_acted(palpate_limiter* limiter, double sampled_s) {
  if (limiter == nullptr) return;
  limiter->measures_lag = true;
  limiter->acted_from_s = sampled_s;
}

void palpate_limiter_stop(palpate_limiter* limiter) {
  if (limiter != nullptr) limiter->stop = true;
}

unsigned palpate_limiter_flags(const palpate_limiter* limiter) {
  return limiter == nullptr ? 0U : limiter->limiter.flags() | limiter->flags;
}

double palpate_limiter_stiffness_share(const palpate_limiter* limiter) {
  return limiter == nullptr ? 1.0 : limiter->guard.stiffness_share();
}

static_assert(PALPATE_LIMIT_NOT_FINITE == force_limit::kNotFinite && PALPATE_LIMIT_CLAMPED == force_limit::kClamped &&
              PALPATE_LIMIT_SLEWED == force_limit::kSlewed && PALPATE_LIMIT_RAMPING == force_limit::kRamping &&
              PALPATE_LIMIT_THERMAL == force_limit::kThermal && PALPATE_LIMIT_STALE == force_limit::kStale &&
              PALPATE_LIMIT_STOPPED == force_limit::kDeviceFault);
