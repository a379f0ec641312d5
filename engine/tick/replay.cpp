#include "engine/tick/replay.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "engine/tick/jnd.h"
#include "engine/tick/sensor_identification.h"

namespace palpate {
namespace {

// The least number of rows for a standard deviation.
constexpr std::size_t kFewestAirRows = 20;

// The standard deviation of the force before the first contact, due to drift of the sensor, inertia and cables. 0 with
// too few rows.
double air_deviation_N(const RecordingRow* rows, std::size_t count, double surface_m) {
  double sum = 0.0, squares = 0.0;
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

// Steps a tick through the rows of one recording.
class Replay {
 public:
  // `rows`: the first rows, from which sensor and noise are identified.
  Replay(const ForceModels& models, const std::vector<RecordingRow>& rows, RecordingColumns columns,
         double surface_offset_m)
      : summary_{identify_sensor(rows.data(), rows.size(), columns)},
        tick_(summary_.sensor, models),
        surface_offset_m_(surface_offset_m),
        surface_m_(common_surface_m(models)),
        least_N_(least_contact_N(rows.data(), rows.size(), surface_m_ + surface_offset_m)) {}

  // To be called with all rows in order.
  void run(const std::vector<RecordingRow>& rows, const ReplayVisitor& visitor) {
    for (const RecordingRow& row : rows) {
      ToolSample sample = tool_sample(row);
      sample.position_m -= surface_offset_m_;
      TickSnapshot snapshot = tick_.step(sample);
      snapshot.in_contact = sample.position_m > surface_m_ || std::abs(row.force_N) > least_N_;
      if (snapshot.in_contact) ++summary_.contact_samples;
      if (visitor) visitor(row, snapshot, tick_);
    }
    summary_.samples += rows.size();
  }
  const ReplaySummary& summary() const { return summary_; }

 private:
  ReplaySummary summary_;
  HapticsTick tick_;
  double surface_offset_m_, surface_m_, least_N_;
};

}  // namespace

double least_contact_N(const RecordingRow* rows, std::size_t count, double surface_m) {
  const double noise_N = std::max(identify_force_noise_N(rows, count), air_deviation_N(rows, count, surface_m));
  return certain_force_N(noise_N);
}

ReplaySummary replay(const Recording& recording, const ForceModels& models, const ReplayVisitor& visitor,
                     double surface_offset_m) {
  Replay replay(models, recording.rows, recording.columns, surface_offset_m);
  replay.run(recording.rows, visitor);
  return replay.summary();
}

Result<ReplaySummary> replay(RecordingReader& reader, const ForceModels& models, const ReplayVisitor& visitor,
                             double surface_offset_m) {
  std::vector<RecordingRow> rows;
  std::optional<Replay> replay;
  for (;;) {
    rows.clear();
    const auto count = reader.read(rows, kSensorIdentificationRows);
    if (!count) return count.error();
    if (!replay) replay.emplace(models, rows, reader.columns(), surface_offset_m);
    if (*count == 0) return replay->summary();
    replay->run(rows, visitor);
  }
}

}  // namespace palpate
