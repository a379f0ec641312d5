#include "engine/tick/haptics_tick.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/tick/jnd.h"
#include "engine/tick/motion_estimator.h"

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

}  // namespace

double least_contact_N(const RecordingRow* rows, std::size_t count, double surface_m) {
  const double noise_N = std::max(identify_force_noise_N(rows, count), air_deviation_N(rows, count, surface_m));
  return certain_force_N(noise_N);
}

ReplaySummary replay(const Recording& recording, const ForceModels& models, const ReplayVisitor& visitor,
                     double surface_offset_m, const Recording* after) {
  const std::vector<RecordingRow>& rows = recording.rows;
  ReplaySummary summary{identify_sensor(rows.data(), rows.size(), recording.columns)};
  HapticsTick tick(summary.sensor, models);
  if (after != nullptr) tick.start_after(*after);
  const double surface_m = common_surface_m(models);
  const double least_N = least_contact_N(rows.data(), rows.size(), surface_m + surface_offset_m);
  for (const RecordingRow& row : rows) {
    ToolSample sample = tool_sample(row);
    sample.position_m -= surface_offset_m;
    tick.step(sample);
    TickSnapshot snapshot = tick.assess();
    snapshot.in_contact = sample.position_m > surface_m || std::abs(row.force_N) > least_N;
    ++summary.samples;
    if (snapshot.in_contact) ++summary.contact_samples;
    if (visitor) visitor(row, snapshot, tick);
  }
  for (std::size_t i = 0; i < models.size(); ++i) summary.began.push_back(tick.began(i));
  return summary;
}

}  // namespace palpate
