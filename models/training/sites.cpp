#include "models/training/sites.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace palpate {
Status validate_sites(const Sites& sites) {
  const Eigen::Index count = sites.count();
  if (count == 0) return Error{"sites: there are no points to fit; give at least one sample in contact"};
  if (sites.dimension() < 1 || sites.dimension() > static_cast<int>(kMaxFeatures))
    return Error{"sites: points have " + std::to_string(sites.dimension()) + " coordinates, expected 1 to " +
                 std::to_string(kMaxFeatures)};
  if (sites.target_N.size() != count || sites.row_scale.size() != count)
    return Error{"sites: found " + std::to_string(sites.target_N.size()) + " entries of target_N and " +
                 std::to_string(sites.row_scale.size()) + " of row_scale, expected " + std::to_string(count) +
                 " of each, one per point"};
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool finite = sites.points.col(i).allFinite() && std::isfinite(sites.target_N[i]) &&
                        std::isfinite(sites.row_scale[i]) && sites.row_scale[i] >= 0.0;
    if (!finite)
      return Error{"sites: site " + std::to_string(i) +
                   " is not finite or has a negative row_scale; expected finite points, forces and factors"};
  }
  return {};
}

Sites even_subset(const Sites& sites, Eigen::Index most) {
  const Eigen::Index count = std::min(sites.count(), most);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < count; ++k) kept.push_back(k * sites.count() / count);
  Sites subset = sites;
  subset.points = sites.points(Eigen::all, kept);
  subset.target_N = sites.target_N(kept);
  subset.row_scale = sites.row_scale(kept);
  return subset;
}

std::vector<Eigen::Index> distinct_sites(const Sites& sites) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(sites.count()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const auto point = [&](Eigen::Index i) { return sites.points.col(i); };
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) {
    return std::lexicographical_compare(point(a).begin(), point(a).end(), point(b).begin(), point(b).end());
  });
  const auto same = [&](Eigen::Index a, Eigen::Index b) { return point(a) == point(b); };
  order.erase(std::unique(order.begin(), order.end(), same), order.end());
  std::sort(order.begin(), order.end());
  return order;
}

std::size_t draw_first(std::vector<Eigen::Index>& indices, Eigen::Index most, SplitMix64& random) {
  const std::size_t count = std::min(static_cast<std::size_t>(most), indices.size());
  for (std::size_t j = 0; j < count; ++j) {
    std::swap(indices[j], indices[j + static_cast<std::size_t>(random.below(indices.size() - j))]);
  }
  return count;
}

}  // namespace palpate
