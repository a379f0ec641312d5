#include "models/surface/surface_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/tick/features.h"
#include "models/surface/surface_estimate.h"
#include "models/surface/surface_numbers.h"

namespace palpate {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kRange_m = 1.5e-3;
constexpr double kFarthest_m = 3e-3;  // while it still gets better
constexpr double kCoarseSearchStep_m = 0.1e-3;
constexpr std::size_t kCoarseStride = 4;
constexpr double kFinest_m = 1e-6;
constexpr double kParabolaStep_m = 15e-6;
constexpr double kSignificance = 2.0;  // standard errors
constexpr std::size_t kBlocks = 10;
constexpr double kSearchHuberLimit = 1.0;  // JND
constexpr double kGolden = 0.6180339887498949;

using BlockCosts = std::array<double, kBlocks>;

double sum(const BlockCosts& costs) {
  double total = 0.0;
  for (const double cost : costs) total += cost;
  return total;
}

// Minimum of the parabola through (-1, below), (0, at), (1, above); infinite
// without one.
double vertex(double below, double at, double above) {
  const double curvature = below - 2.0 * at + above;
  return curvature > 0.0 ? 0.5 * (below - above) / curvature : kInfinite;
}

class OffsetSearch {
 public:
  OffsetSearch(const std::vector<SurfaceRow>& rows, const std::vector<std::shared_ptr<const ForceModel>>& models,
         const JndLine& jnd)
      : rows_(rows), models_(models), jnd_(jnd) {}

  // J at `offset_m`, of every `stride`-th row.
  BlockCosts costs(double offset_m, std::size_t stride) const {
    BlockCosts costs{};
    for (const auto& model : models_) add_costs(*model, offset_m, stride, costs);
    return costs;
  }

  double coarse() const {
    double best_m = 0.0;
    double least = sum(costs(0.0, kCoarseStride));
    for (const double direction : {-1.0, 1.0}) {
      double before = kInfinite;
      for (int i = 1; i * kCoarseSearchStep_m < kFarthest_m + 0.5 * kCoarseSearchStep_m; ++i) {
        const double at_m = direction * i * kCoarseSearchStep_m;
        const double cost = sum(costs(at_m, kCoarseStride));
        if (cost < least) {
          least = cost;
          best_m = at_m;
        }
        if (i * kCoarseSearchStep_m > kRange_m - 0.5 * kCoarseSearchStep_m && !(cost < before)) break;
        before = cost;
      }
    }
    return best_m;
  }

  double golden(double low_m, double high_m) const {
    double a_m = high_m - kGolden * (high_m - low_m);
    double b_m = low_m + kGolden * (high_m - low_m);
    double a = sum(costs(a_m, 1));
    double b = sum(costs(b_m, 1));
    while (high_m - low_m > kFinest_m) {
      if (a < b) {
        high_m = b_m;
        b_m = a_m;
        b = a;
        a_m = high_m - kGolden * (high_m - low_m);
        a = sum(costs(a_m, 1));
      } else {
        low_m = a_m;
        a_m = b_m;
        a = b;
        b_m = low_m + kGolden * (high_m - low_m);
        b = sum(costs(b_m, 1));
      }
    }
    return 0.5 * (low_m + high_m);
  }

 private:
  void add_costs(const ForceModel& model, double offset_m, std::size_t stride, BlockCosts& costs) const {
    FeatureFilter filter(model.features());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      ToolSample sample = rows_[i].sample;
      MotionEstimate motion = rows_[i].motion;
      sample.position_m -= offset_m;
      motion.position_m -= offset_m;
      const FeatureVector& vector = filter.update(sample, motion);
      if (i % stride != 0) continue;
      const double force_N = vector.in_contact ? model.evaluate(vector.values.data()).force_N : 0.0;
      const double error_over_jnd = (force_N - rows_[i].force_N) / jnd_.at(rows_[i].force_N);
      costs[i * kBlocks / rows_.size()] += huber(error_over_jnd, kSearchHuberLimit);
    }
  }

  const std::vector<SurfaceRow>& rows_;
  const std::vector<std::shared_ptr<const ForceModel>>& models_;
  JndLine jnd_;
};

double jackknife_error_m(const std::array<BlockCosts, 3>& around) {
  std::array<double, kBlocks> without{};
  double mean = 0.0;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    std::array<double, 3> cost{};
    for (std::size_t side = 0; side < 3; ++side) cost[side] = sum(around[side]) - around[side][block];
    without[block] = vertex(cost[0], cost[1], cost[2]);
    mean += without[block] / kBlocks;
  }
  if (!std::isfinite(mean)) return kInfinite;
  double squares = 0.0;
  for (const double value : without) squares += (value - mean) * (value - mean);
  return kParabolaStep_m * std::sqrt(squares * (kBlocks - 1.0) / kBlocks);
}

}  // namespace

SurfaceLocation locate_surface(const std::vector<SurfaceRow>& rows,
                               const std::vector<std::shared_ptr<const ForceModel>>& models, const JndLine& jnd) {
  if (rows.empty() || models.empty()) return {0.0, kInfinite};
  const OffsetSearch search(rows, models, jnd);
  const double coarse_m = search.coarse();
  const double best_m = search.golden(coarse_m - kCoarseSearchStep_m, coarse_m + kCoarseSearchStep_m);
  const std::array<BlockCosts, 3> around{search.costs(best_m - kParabolaStep_m, 1), search.costs(best_m, 1),
                                         search.costs(best_m + kParabolaStep_m, 1)};
  SurfaceLocation location{best_m, jackknife_error_m(around)};
  const bool significant = std::abs(best_m) > std::max(kLeastOffset_m, kSignificance * location.standard_error_m);
  if (!significant) location.offset_m = 0.0;
  return location;
}

}  // namespace palpate
