// The C interface of models/library/palpate/palpate.h: handles around a fitted model, a
// haptics tick with that one model, and a force limiter. No exception leaves a function.
#include "models/library/palpate/palpate.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/atomic_file.h"
#include "engine/base/result.h"
#include "engine/live/force_limiter.h"
#include "engine/tick/haptics_tick.h"
#include "engine/tick/replay.h"
#include "engine/tick/sensor_identification.h"
#include "models/export/export_c.h"
#include "models/library/c_interface.h"
#include "models/model/file/model_io.h"

struct palpate_stream {
  palpate_stream(const palpate::SensorSpec& spec, std::shared_ptr<const palpate::ForceModel> model)
      : sensor(spec), tick(spec, {std::move(model)}) {}

  palpate::SensorSpec sensor;
  palpate::HapticsTick tick;
  // The values of the last accepted sample.
  bool out_of_domain = false;
  double predicted_error_N = std::numeric_limits<double>::quiet_NaN();
};

struct palpate_limiter {
  explicit palpate_limiter(const palpate::ForceLimits& limits) : limiter(limits) {}

  palpate::ForceLimiter limiter;
  bool stop = false;
};

namespace palpate::library {
namespace {

// A number from the caller, and whether it may be 0 or infinite.
struct GivenNumber {
  const char* name;
  double value;
  bool zero = false;
  bool infinite = false;
};

Status check_numbers(std::initializer_list<GivenNumber> numbers) {
  for (const auto& [name, value, zero, infinite] : numbers) {
    if ((value > 0.0 || (zero && value == 0.0)) && (infinite || std::isfinite(value))) continue;
    return Error{std::string(name) + ": found " + std::to_string(value) + ", expected a " +
                 (infinite ? "" : "finite ") + "number " + (zero ? "of 0 or more" : "above 0")};
  }
  return {};
}

Result<SensorSpec> sensor_spec(const palpate_sensor& sensor) {
  SensorSpec spec;
  spec.encoder_step_m = sensor.encoder_step_m;
  spec.position_noise_m = sensor.position_noise_m;
  spec.has_velocity = sensor.has_velocity != 0;
  spec.has_acceleration = sensor.has_acceleration != 0;
  if (spec.has_velocity) spec.velocity_noise_m_per_s = sensor.velocity_noise_m_per_s;
  if (spec.has_acceleration) spec.acceleration_noise_m_per_s2 = sensor.acceleration_noise_m_per_s2;
  const Status status =
      check_numbers({{"encoder_step_m", spec.encoder_step_m, true},
                     {"position_noise_m", spec.position_noise_m, true},
                     {"velocity_noise_m_per_s", spec.velocity_noise_m_per_s, !spec.has_velocity},
                     {"acceleration_noise_m_per_s2", spec.acceleration_noise_m_per_s2, !spec.has_acceleration}});
  if (!status) return status.error();
  return spec;
}

palpate_sensor sensor_from(const SensorSpec& spec) {
  return {spec.encoder_step_m,         spec.position_noise_m,
          spec.velocity_noise_m_per_s, spec.acceleration_noise_m_per_s2,
          spec.has_velocity ? 1 : 0,   spec.has_acceleration ? 1 : 0};
}

// Identifies the sensor from the first kSensorIdentificationRows samples.
SensorSpec sensor_of_samples(size_t n, const double* time_s, const double* position_m, const double* velocity_m_per_s,
                             const double* acceleration_m_per_s2) {
  std::vector<RecordingRow> rows(std::min(n, kSensorIdentificationRows));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time_s = time_s[i];
    rows[i].position_m = position_m[i];
    if (velocity_m_per_s != nullptr) rows[i].velocity_m_per_s = velocity_m_per_s[i];
    if (acceleration_m_per_s2 != nullptr) rows[i].acceleration_m_per_s2 = acceleration_m_per_s2[i];
  }
  return identify_sensor(rows.data(), rows.size(), {velocity_m_per_s != nullptr, acceleration_m_per_s2 != nullptr});
}

Result<ForceLimits> force_limits(const palpate_limits& limits) {
  const Status status = check_numbers({{"largest_N", limits.largest_N},
                                       {"fastest_N_per_s", limits.fastest_N_per_s},
                                       {"ramp_s", limits.ramp_s, true},
                                       {"continuous_N", limits.continuous_N, false, true},
                                       {"thermal_time_s", limits.thermal_time_s},
                                       {"stale_after_s", limits.stale_after_s, false, true},
                                       {"stop_s", limits.stop_s, true}});
  if (!status) return status.error();
  return ForceLimits{limits.largest_N,      limits.fastest_N_per_s, limits.ramp_s, limits.continuous_N,
                     limits.thermal_time_s, limits.stale_after_s,   limits.stop_s};
}

double step(palpate_stream& stream, const ToolSample& sample) noexcept {
  const TickSnapshot& snapshot = stream.tick.step(sample);
  if (snapshot.fault == TickFault::bad_sample || snapshot.fault == TickFault::time_not_later) return 0.0;
  stream.out_of_domain = (snapshot.out_of_domain_mask & 1U) != 0;
  stream.predicted_error_N = snapshot.predicted_error_N[0];
  return snapshot.force_N[0];
}

}  // namespace
}  // namespace palpate::library

using palpate::Error;
using palpate::Result;
using palpate::Status;
using palpate::library::made;
using palpate::library::status_of;

int palpate_abi_version(void) { return PALPATE_ABI_VERSION; }

palpate_model* palpate_model_load(const char* path, char* error, size_t error_size) {
  return made<palpate_model>(error, error_size, [&]() -> Result<palpate_model*> {
    if (path == nullptr) return Error{"found no path, expected that of a model file"};
    auto model = palpate::load_model(path);
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
  return status_of(error, error_size, [&]() -> Status {
    if (model == nullptr || path == nullptr) return Error{"found no model or no path, expected both"};
    return palpate::save_model(path, model->model->data(), overwrite != 0);
  });
}

int palpate_model_export_c(const palpate_model* model, double encoder_step_m, int single_precision, const char* path,
                           int overwrite, char* error, size_t error_size) {
  return status_of(error, error_size, [&]() -> Status {
    if (model == nullptr || path == nullptr) return Error{"found no model or no path, expected both"};
    const Status valid = palpate::library::check_numbers({{"encoder_step_m", encoder_step_m, true}});
    if (!valid) return valid;
    const palpate::ModelData& data = model->model->data();
    const auto file = palpate::export_c(data, {single_precision != 0, sensor_with_step(data, encoder_step_m)});
    return palpate::write_file_atomically(path, file.text, overwrite != 0);
  });
}

size_t palpate_model_feature_count(const palpate_model* model) {
  return model == nullptr ? 0 : model->feature_names.size();
}

const char* palpate_model_feature_name(const palpate_model* model, size_t index) {
  return index < palpate_model_feature_count(model) ? model->feature_names[index].c_str() : "";
}

int palpate_model_evaluate(const palpate_model* model, size_t n, const double* features, double* force_N,
                           double* bound_N, double* trend_N, unsigned char* outside) {
  if (model == nullptr || features == nullptr) return -1;
  const palpate::FittedModel& fitted = *model->model;
  const palpate::TrendInputs inputs(fitted.features());
  for (size_t i = 0; i < n; ++i, features += fitted.features().size()) {
    const palpate::ForceEstimate estimate = fitted.evaluate(features);
    if (force_N != nullptr) force_N[i] = estimate.force_N;
    if (bound_N != nullptr) bound_N[i] = estimate.predicted_error_N;
    if (trend_N != nullptr) trend_N[i] = fitted.data().trend.at(features, inputs);
    if (outside != nullptr) outside[i] = estimate.out_of_domain ? 1 : 0;
  }
  return 0;
}

double palpate_jnd_N(const palpate_model* model, double force_N) {
  return (model == nullptr ? palpate::JndLine{} : model->model->data().jnd).at(force_N);
}

palpate_stream* palpate_stream_new(const palpate_model* model, double encoder_step_m, char* error, size_t error_size) {
  palpate_sensor sensor{};
  if (model != nullptr) {
    sensor = palpate::library::sensor_from(palpate::sensor_with_step(model->model->data(), encoder_step_m));
  }
  return palpate_stream_new_with_sensor(model, &sensor, error, error_size);
}

palpate_stream* palpate_stream_new_with_sensor(const palpate_model* model, const palpate_sensor* sensor, char* error,
                                               size_t error_size) {
  return made<palpate_stream>(error, error_size, [&]() -> Result<palpate_stream*> {
    if (model == nullptr) return Error{"found no model, expected one that palpate_model_load gave"};
    if (sensor == nullptr) return Error{"found no sensor, expected a palpate_sensor"};
    const auto spec = palpate::library::sensor_spec(*sensor);
    if (!spec) return spec.error();
    return new palpate_stream(*spec, model->model);
  });
}

int palpate_sensor_of_recording(const char* path, palpate_sensor* sensor, char* error, size_t error_size) {
  return status_of(error, error_size, [&]() -> Status {
    if (path == nullptr || sensor == nullptr) return Error{"found no path or no sensor to fill, expected both"};
    auto reader = palpate::RecordingReader::open(path);
    if (!reader) return reader.error();
    std::vector<palpate::RecordingRow> rows(palpate::kSensorIdentificationRows);
    const auto count = reader->read(rows.data(), rows.size());
    if (!count) return count.error();
    *sensor = palpate::library::sensor_from(palpate::identify_sensor(rows.data(), *count, reader->columns()));
    return {};
  });
}

int palpate_sensor_of_samples(size_t n, const double* time_s, const double* position_m, const double* velocity_m_per_s,
                              const double* acceleration_m_per_s2, palpate_sensor* sensor) {
  if (time_s == nullptr || position_m == nullptr || sensor == nullptr) return -1;
  return status_of(nullptr, 0, [&]() -> Status {
    *sensor = palpate::library::sensor_from(
        palpate::library::sensor_of_samples(n, time_s, position_m, velocity_m_per_s, acceleration_m_per_s2));
    return {};
  });
}

int palpate_in_contact(size_t n, const double* position_m, const double* force_N, unsigned char* in_contact) {
  if (position_m == nullptr || force_N == nullptr || in_contact == nullptr) return -1;
  return status_of(nullptr, 0, [&]() -> Status {
    std::vector<palpate::RecordingRow> rows(std::min(n, palpate::kSensorIdentificationRows));
    for (size_t i = 0; i < rows.size(); ++i) rows[i] = {0.0, position_m[i], force_N[i]};
    const double least_N = palpate::least_contact_N(rows.data(), rows.size(), 0.0);
    for (size_t i = 0; i < n; ++i) in_contact[i] = position_m[i] > 0.0 || std::abs(force_N[i]) > least_N ? 1 : 0;
    return {};
  });
}

void palpate_stream_free(palpate_stream* stream) { delete stream; }

void palpate_stream_reset(palpate_stream* stream) {
  if (stream == nullptr) return;
  stream->tick.reset();
  stream->out_of_domain = false;
  stream->predicted_error_N = std::numeric_limits<double>::quiet_NaN();
}

double palpate_stream_force(palpate_stream* stream, double time_s, double position_m) {
  return palpate_stream_force_with_motion(stream, time_s, position_m, 0.0, 0.0);
}

double palpate_stream_force_with_motion(palpate_stream* stream, double time_s, double position_m,
                                        double velocity_m_per_s, double acceleration_m_per_s2) {
  if (stream == nullptr) return 0.0;
  return palpate::library::step(*stream, {time_s, position_m, stream->sensor.has_velocity ? velocity_m_per_s : 0.0,
                                          stream->sensor.has_acceleration ? acceleration_m_per_s2 : 0.0});
}

int palpate_stream_forces(palpate_stream* stream, size_t n, const double* time_s, const double* position_m,
                          double* force_N, double* bound_N) {
  return palpate_stream_forces_with_motion(stream, n, time_s, position_m, nullptr, nullptr, force_N, bound_N, nullptr);
}

int palpate_stream_forces_with_motion(palpate_stream* stream, size_t n, const double* time_s, const double* position_m,
                                      const double* velocity_m_per_s, const double* acceleration_m_per_s2,
                                      double* force_N, double* bound_N, double* features) {
  if (stream == nullptr || time_s == nullptr || position_m == nullptr) return -1;
  const size_t width = stream->tick.model(0).features().size();
  for (size_t i = 0; i < n; ++i) {
    const double force = palpate_stream_force_with_motion(
        stream, time_s[i], position_m[i], velocity_m_per_s != nullptr ? velocity_m_per_s[i] : 0.0,
        acceleration_m_per_s2 != nullptr ? acceleration_m_per_s2[i] : 0.0);
    if (force_N != nullptr) force_N[i] = force;
    if (bound_N != nullptr) bound_N[i] = stream->predicted_error_N;
    if (features != nullptr) std::copy_n(stream->tick.features_of(0).values.data(), width, features + i * width);
  }
  return 0;
}

int palpate_stream_out_of_domain(const palpate_stream* stream) {
  return stream != nullptr && stream->out_of_domain ? 1 : 0;
}

double palpate_stream_predicted_error(const palpate_stream* stream) {
  return stream == nullptr ? std::numeric_limits<double>::quiet_NaN() : stream->predicted_error_N;
}

void palpate_limits_default(palpate_limits* limits) {
  if (limits == nullptr) return;
  const palpate::ForceLimits by_default;
  *limits = {by_default.largest_N,      by_default.fastest_N_per_s, by_default.ramp_s, by_default.continuous_N,
             by_default.thermal_time_s, by_default.stale_after_s,   by_default.stop_s};
}

palpate_limiter* palpate_limiter_new(const palpate_limits* limits, char* error, size_t error_size) {
  return made<palpate_limiter>(error, error_size, [&]() -> Result<palpate_limiter*> {
    palpate_limits chosen;
    palpate_limits_default(&chosen);
    if (limits != nullptr) chosen = *limits;
    const auto checked = palpate::library::force_limits(chosen);
    if (!checked) return checked.error();
    return new palpate_limiter(*checked);
  });
}

void palpate_limiter_free(palpate_limiter* limiter) { delete limiter; }

double palpate_limiter_force(palpate_limiter* limiter, double commanded_N, double step_s, double sample_age_s) {
  if (limiter == nullptr) return 0.0;
  palpate::ForceConditions conditions;
  conditions.sample_age_s = sample_age_s;
  conditions.device_fault = limiter->stop;
  limiter->stop = false;
  return limiter->limiter.limit(commanded_N, step_s, conditions);
}

void palpate_limiter_stop(palpate_limiter* limiter) {
  if (limiter != nullptr) limiter->stop = true;
}

unsigned palpate_limiter_flags(const palpate_limiter* limiter) {
  return limiter == nullptr ? 0U : limiter->limiter.flags();
}

static_assert(PALPATE_LIMIT_NOT_FINITE == palpate::force_limit::kNotFinite);
static_assert(PALPATE_LIMIT_CLAMPED == palpate::force_limit::kClamped);
static_assert(PALPATE_LIMIT_SLEWED == palpate::force_limit::kSlewed);
static_assert(PALPATE_LIMIT_RAMPING == palpate::force_limit::kRamping);
static_assert(PALPATE_LIMIT_THERMAL == palpate::force_limit::kThermal);
static_assert(PALPATE_LIMIT_STALE == palpate::force_limit::kStale);
static_assert(PALPATE_LIMIT_STOPPED == palpate::force_limit::kDeviceFault);
