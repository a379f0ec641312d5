#include "models/correction/sites.h"

#include <algorithm>
#include <numeric>

namespace palpate {

Status validate_sites(const Sites& sites) {
  if (sites.points.allFinite() && sites.target_N.allFinite() && sites.row_scale.allFinite()) return {};
  return Error{"a feature or force of the training is not finite; check the recording for extreme values"};
}

Sites even_subset(const Sites& sites, Eigen::Index most) {
  const Eigen::Index count = std::min(sites.count(), most);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < count; ++k) kept.push_back(k * sites.count() / count);
  Sites subset = sites;
  subset.points = sites.points(Eigen::all, kept);
  subset.target_N = sites.target_N(kept);
  subset.row_scale = sites.row_scale(kept);
  subset.force_N.resize(0);
  subset.samples.resize(0);
  subset.fold.clear();
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
