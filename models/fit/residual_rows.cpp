#include "models/fit/residual_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/parallel.h"
#include "models/model/domain_guard.h"

namespace palpate {
namespace {

// More rows give the same selection.
constexpr std::size_t kMostRows = 2500;
constexpr Eigen::Index kMostSites = 1500;  // a tenth of a second for each fold

}  // namespace

std::vector<Eigen::Index> ResidualRows::outside(int without) const {
  std::vector<Eigen::Index> others;
  for (std::size_t i = 0; i < fold.size(); ++i) {
    if (fold[i] != without) others.push_back(static_cast<Eigen::Index>(i));
  }
  return others;
}

Eigen::VectorXd ResidualRows::residual_N(int without) const {
  Eigen::VectorXd residual_N = force_N - trend_N.col(without);
  for (Eigen::Index i = 0; i < residual_N.size(); ++i) {
    if (no_force[static_cast<std::size_t>(i)]) residual_N(i) = std::min(0.0, residual_N(i));
  }
  return residual_N;
}

double ResidualRows::predicted_N(const ModelData& common, std::size_t i, double inner_radius, double h) const {
  const double outer_to_inner = common.cover.outer_radius / common.cover.inner_radius;
  const double trust = trust_at_distance(distance[i], inner_radius, outer_to_inner * inner_radius);
  const double limit_N = common.correction_limit_N;
  const double trend = trend_N(static_cast<Eigen::Index>(i), fold[i]);
  return std::max(common.lowest_force_N, trend + trust * std::clamp(h, -limit_N, limit_N));
}

Sites ResidualRows::sites_without(int without, double smoothing) const {
  const std::vector<Eigen::Index> others = outside(without);
  return even_subset({points(Eigen::all, others), residual_N(without)(others), row_scale(others), kernel, smoothing},
                     kMostSites);
}

void ResidualRows::find_distances() {
  distance.assign(fold.size(), std::numeric_limits<double>::infinity());
  parallel_for(folds(), [&](int mine) {
    const std::vector<Eigen::Index> others = outside(mine);
    if (others.empty()) return;
    const NearestDistance nearest(points(Eigen::all, others));
    for (std::size_t i = 0; i < fold.size(); ++i) {
      if (fold[i] != mine) continue;
      const Eigen::VectorXd point = points.col(static_cast<Eigen::Index>(i));
      distance[i] = std::sqrt(nearest.nearest_squared(point.data()));
    }
  });
}

ResidualRows residual_rows(const ModelData& common, const TrendColumns& columns, const TrendWeights& weights,
                           const Eigen::MatrixXd& features, const Eigen::MatrixXd& left_out_trends) {
  const double no_force_N = columns.samples().no_force_N();
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < columns.count(); i += columns.count() / kMostRows + 1) order.push_back(i);
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return columns.fold(i); });
  const auto n = static_cast<Eigen::Index>(order.size());
  ResidualRows out;
  out.points.resize(features.rows(), n);
  for (Eigen::VectorXd* values : {&out.force_N, &out.depth_m, &out.row_scale}) values->resize(n);
  out.trend_N.resize(n, left_out_trends.cols());
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t row = order[static_cast<std::size_t>(k)];
    const auto in_contact = static_cast<Eigen::Index>(row * columns.stride());
    out.points.col(k) = (features.col(in_contact) - common.offset).cwiseQuotient(common.scale);
    out.force_N(k) = columns.force_N(row);
    out.depth_m(k) = columns.depth_m(row);
    out.row_scale(k) = row_scale(weights.weighting, weights.jnd, out.force_N(k));
    out.trend_N.row(k) = columns.terms().row(static_cast<Eigen::Index>(row)) * left_out_trends;
    out.fold.push_back(columns.fold(row));
    out.no_force.push_back(std::abs(out.force_N(k)) <= no_force_N ? 1 : 0);
  }
  out.strokes = columns.samples().strokes;
  out.find_distances();
  return out;
}

}  // namespace palpate
