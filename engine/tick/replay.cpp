#include "engine/tick/replay.h"

#include <string>

#include "engine/tick/sensor_identification.h"

namespace palpate {
namespace {

Status check_count(const ForceModels& models) {
  if (models.size() <= kMaxModels) return {};
  return Error{"found " + std::to_string(models.size()) + " models, expected at most " + std::to_string(kMaxModels) +
               "; replay them in several runs"};
}

void run(HapticsTick& tick, const RecordingRow* rows, std::size_t count, const ReplayVisitor& visitor,
         double surface_offset_m, ReplaySummary& summary) {
  for (std::size_t i = 0; i < count; ++i) {
    ToolSample sample = tool_sample(rows[i]);
    sample.position_m -= surface_offset_m;
    const TickSnapshot& snapshot = tick.step(sample);
    ++summary.samples;
    if (snapshot.in_contact) ++summary.contact_samples;
    if (snapshot.fault != TickFault::none) ++summary.faults;
    if (visitor) visitor(rows[i], snapshot, tick);
  }
}

// Fills `rows` as far as the reader has any.
Result<std::size_t> read_full(RecordingReader& reader, std::vector<RecordingRow>& rows) {
  std::size_t filled = 0;
  while (filled < rows.size()) {
    const Result<std::size_t> count = reader.read(rows.data() + filled, rows.size() - filled);
    if (!count) return count.error();
    if (*count == 0) break;
    filled += *count;
  }
  return filled;
}

}  // namespace

Result<ReplaySummary> replay(const Recording& recording, const ForceModels& models, const ReplayVisitor& visitor,
                             double surface_offset_m) {
  if (const Status status = check_count(models); !status) return status.error();
  ReplaySummary summary;
  summary.sensor = identify_sensor(recording.rows.data(), recording.rows.size(), recording.columns);
  HapticsTick tick(summary.sensor, models);
  run(tick, recording.rows.data(), recording.rows.size(), visitor, surface_offset_m, summary);
  return summary;
}

Result<ReplaySummary> replay(RecordingReader& reader, const ForceModels& models, const ReplayVisitor& visitor,
                             double surface_offset_m) {
  if (const Status status = check_count(models); !status) return status.error();
  // One buffer for all: the rows that identification needs are also the chunk.
  std::vector<RecordingRow> rows(kSensorIdentificationRows);
  Result<std::size_t> count = read_full(reader, rows);
  if (!count) return count.error();
  ReplaySummary summary;
  summary.sensor = identify_sensor(rows.data(), *count, reader.columns());
  HapticsTick tick(summary.sensor, models);
  while (*count > 0) {
    run(tick, rows.data(), *count, visitor, surface_offset_m, summary);
    count = read_full(reader, rows);
    if (!count) return count.error();
  }
  return summary;
}

}  // namespace palpate
