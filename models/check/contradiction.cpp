#include "models/check/contradiction.h"

#include <algorithm>
#include <vector>

#include "models/recordings/force_curve.h"

namespace palpate {
namespace {

constexpr double kApartShare = 0.8;
constexpr double kLeastJnds = 2.0;

std::vector<ForceAtPosition> forces_of(const Recording& recording) {
  std::vector<ForceAtPosition> forces;
  for (const RecordingRow& row : recording.rows) forces.push_back({row.position_m, row.force_N});
  return forces;
}

double inward_speed(const Recording& recording) {
  double path_m = 0.0;
  double time_s = 0.0;
  for (std::size_t i = 1; i < recording.rows.size(); ++i) {
    const double step_m = recording.rows[i].position_m - recording.rows[i - 1].position_m;
    if (!(step_m > 0.0)) continue;
    path_m += step_m;
    time_s += recording.rows[i].time_s - recording.rows[i - 1].time_s;
  }
  return time_s > 0.0 ? path_m / time_s : 0.0;
}

}  // namespace

std::optional<Contradiction> find_contradiction(const Recording& first, const Recording& second, const JndLine& jnd) {
  const std::vector<ForceAtPosition> a = forces_of(first);
  const std::vector<ForceAtPosition> b = forces_of(second);
  const double bin_m = common_bin_m(a, b);
  if (!(bin_m > 0.0)) return std::nullopt;
  const ForceCurve one(a, bin_m);
  const ForceCurve other(b, bin_m);
  const auto found = difference(one, other, 0.0, jnd);
  if (!found || found->apart_share < kApartShare || !(found->median_jnds > kLeastJnds)) return std::nullopt;
  if (find_shift_m(one, other, jnd)) return std::nullopt;
  const double speeds[] = {inward_speed(first), inward_speed(second)};
  const double slower = std::min(speeds[0], speeds[1]);
  return Contradiction{found->median_N, slower > 0.0 ? std::max(speeds[0], speeds[1]) / slower : 1.0};
}

}  // namespace palpate
