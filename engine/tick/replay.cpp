#include "engine/tick/replay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "engine/tick/jnd.h"
#include "engine/tick/sensor_identification.h"

namespace palpate {
namespace {

Status check_count(const ForceModels& models) {
  if (models.size() <= kMaxModels) return {};
  return Error{"found " + std::to_string(models.size()) + " models, expected at most " + std::to_string(kMaxModels) +
               "; replay them in several runs"};
}

// The least number of rows for a standard deviation.
constexpr std::size_t kFewestAirRows = 20;

// The standard deviation of the force before the first contact, due to drift of the sensor, inertia and cables. 0 with
// too few rows.
double air_deviation_N(const RecordingRow* rows, std::size_t count, double surface_m) {
  double sum = 0.0;
  double squares = 0.0;
  std::size_t air = 0;
  for (; air < count && rows[air].position_m <= surface_m; ++air) {
    sum += rows[air].force_N;
    squares += rows[air].force_N * rows[air].force_N;
  }
  if (air < kFewestAirRows) return 0.0;
  const auto n = static_cast<double>(air);
  return std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)));
}

double common_surface_m(const ForceModels& models) {
  double outermost_m = std::numeric_limits<double>::infinity();
  for (const auto& model : models) {
    const double own_m = surface_position_m(model->features());
    if (own_m != 0.0) outermost_m = std::min(outermost_m, own_m);
  }
  return std::isfinite(outermost_m) ? outermost_m : 0.0;
}

struct ContactRule {
  double surface_m = 0.0;
  double least_N = 0.0;
};

ContactRule contact_rule(const ForceModels& models, const RecordingRow* rows, std::size_t count,
                         double surface_offset_m) {
  const double surface_m = common_surface_m(models);
  return {surface_m, least_contact_N(rows, count, surface_m + surface_offset_m)};
}

void run(HapticsTick& tick, const ContactRule& contact, const RecordingRow* rows, std::size_t count,
         const ReplayVisitor& visitor, double surface_offset_m, ReplaySummary& summary) {
  for (std::size_t i = 0; i < count; ++i) {
    ToolSample sample = tool_sample(rows[i]);
    sample.position_m -= surface_offset_m;
    TickSnapshot snapshot = tick.step(sample);
    snapshot.in_contact = sample.position_m > contact.surface_m || std::abs(rows[i].force_N) > contact.least_N;
    ++summary.samples;
    if (snapshot.in_contact) ++summary.contact_samples;
    if (visitor) visitor(rows[i], snapshot, tick);
  }
}

}  // namespace

double least_contact_N(const RecordingRow* rows, std::size_t count, double surface_m) {
  const double noise_N = std::max(identify_force_noise_N(rows, count), air_deviation_N(rows, count, surface_m));
  return certain_force_N(noise_N);
}

Result<ReplaySummary> replay(const Recording& recording, const ForceModels& models, const ReplayVisitor& visitor,
                             double surface_offset_m) {
  if (const Status status = check_count(models); !status) return status.error();
  ReplaySummary summary;
  summary.sensor = identify_sensor(recording.rows.data(), recording.rows.size(), recording.columns);
  HapticsTick tick(summary.sensor, models);
  const RecordingRow* const rows = recording.rows.data();
  run(tick, contact_rule(models, rows, recording.rows.size(), surface_offset_m), rows, recording.rows.size(), visitor,
      surface_offset_m, summary);
  return summary;
}

Result<ReplaySummary> replay(RecordingReader& reader, const ForceModels& models, const ReplayVisitor& visitor,
                             double surface_offset_m) {
  if (const Status status = check_count(models); !status) return status.error();
  // One buffer: the rows for the identification are also the first chunk.
  std::vector<RecordingRow> rows(kSensorIdentificationRows);
  Result<std::size_t> count = reader.read(rows.data(), rows.size());
  if (!count) return count.error();
  ReplaySummary summary;
  summary.sensor = identify_sensor(rows.data(), *count, reader.columns());
  const ContactRule contact = contact_rule(models, rows.data(), *count, surface_offset_m);
  HapticsTick tick(summary.sensor, models);
  while (*count > 0) {
    run(tick, contact, rows.data(), *count, visitor, surface_offset_m, summary);
    count = reader.read(rows.data(), rows.size());
    if (!count) return count.error();
  }
  return summary;
}

}  // namespace palpate
