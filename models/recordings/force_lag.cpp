#include "models/recordings/force_lag.h"

#include "models/recordings/common_fit.h"

namespace palpate {
namespace {

constexpr double kMostLag_s = 0.05;
constexpr double kCoarse_s = 0.005;  // between lags, and at least between rows
constexpr double kFine_s = 0.2e-3;

// Strokes at different speeds distinguish a lag from memory; one press does not.
constexpr int kLeastStrokes = 3;

// Counts how often the tool passes the middle of its range inwards.
int strokes_of(const std::vector<SurfaceRow>& rows, double middle_m) {
  int strokes = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i - 1].motion.position_m <= middle_m && rows[i].motion.position_m > middle_m) ++strokes;
  }
  return strokes;
}

// The first kSearchRows rows with at least kCoarse_s between them.
std::vector<SurfaceRow> first_rows(const std::vector<SurfaceRow>& rows) {
  std::vector<SurfaceRow> kept;
  for (const SurfaceRow& row : rows) {
    if (kept.size() == kSearchRows) break;
    if (kept.empty() || row.sample.time_s >= kept.back().sample.time_s + kCoarse_s) kept.push_back(row);
  }
  return kept;
}

}  // namespace

OffsetEstimate find_force_lag(const std::vector<SurfaceRow>& rows, double force_noise_N) {
  const std::vector<SurfaceRow> some = first_rows(rows);
  if (some.size() < 100) return {};
  const double step_s = (some.back().sample.time_s - some.front().sample.time_s) / static_cast<double>(some.size() - 1);
  if (step_s > 10.0 * kLagAccuracy_s) return {};
  const auto [low_m, high_m] = position_range_m(some);
  if (!(high_m > low_m) || strokes_of(some, 0.5 * (low_m + high_m)) < kLeastStrokes) return {};
  const CommonFit fit(low_m, high_m, force_noise_N);
  return estimate_offset([&](double lag_s) { return fit.residual(some, 0.0, lag_s); },
                         {-kMostLag_s, kMostLag_s, kCoarse_s, kFine_s, kLagAccuracy_s, kLagAccuracy_s});
}

std::vector<SurfaceRow> without_lag(const std::vector<SurfaceRow>& rows, double lag_s) {
  std::vector<SurfaceRow> moved;
  std::size_t at = 0;
  for (const SurfaceRow& row : rows) {
    const auto force_N = force_at(rows, row.sample.time_s + lag_s, at);
    if (!force_N) continue;
    moved.push_back(row);
    moved.back().force_N = *force_N;
  }
  return moved;
}

}  // namespace palpate
