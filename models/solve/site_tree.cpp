#include "models/solve/site_tree.h"

#include <algorithm>
#include <numeric>

namespace palpate {

SiteTree::SiteTree(const Eigen::MatrixXd& points)
    : points_(points),
      order_(static_cast<std::size_t>(points.cols())),
      leaves_{{0, static_cast<std::size_t>(points.cols())}},
      leaf_of_(static_cast<std::size_t>(points.cols()), 0) {
  std::iota(order_.begin(), order_.end(), Eigen::Index{0});
}

Eigen::VectorXd SiteTree::barycentre(Eigen::Index leaf) const {
  const Leaf& range = leaves_[static_cast<std::size_t>(leaf)];
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(points_.rows());
  for (std::size_t i = range.begin; i < range.end; ++i) sum += points_.col(order_[i]);
  return sum / static_cast<double>(range.end - range.begin);
}

bool SiteTree::split(Eigen::Index leaf) {
  const Leaf range = leaves_[static_cast<std::size_t>(leaf)];
  Eigen::VectorXd low = points_.col(order_[range.begin]);
  Eigen::VectorXd high = low;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    low = low.cwiseMin(points_.col(order_[i]));
    high = high.cwiseMax(points_.col(order_[i]));
  }
  Eigen::Index widest = 0;
  if (!((high - low).maxCoeff(&widest) > 0.0)) return false;
  const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(range.begin);
  const auto end = order_.begin() + static_cast<std::ptrdiff_t>(range.end);
  const auto value = [&](Eigen::Index site) { return points_(widest, site); };
  std::sort(begin, end,
            [&](Eigen::Index a, Eigen::Index b) { return value(a) != value(b) ? value(a) < value(b) : a < b; });
  // Splits between different values, as near to the middle as possible.
  const auto middle = begin + (end - begin) / 2;
  const double median = value(*middle);
  const auto first_equal = std::partition_point(begin, end, [&](Eigen::Index s) { return value(s) < median; });
  const auto first_above = std::partition_point(begin, end, [&](Eigen::Index s) { return value(s) <= median; });
  const bool lower_is_nearer = middle - first_equal <= first_above - middle;
  auto boundary = lower_is_nearer ? first_equal : first_above;
  if (boundary == begin) boundary = first_above;
  if (boundary == end) boundary = first_equal;
  const auto at = static_cast<std::size_t>(boundary - order_.begin());
  leaves_[static_cast<std::size_t>(leaf)].end = at;
  for (std::size_t i = at; i < range.end; ++i) leaf_of_[static_cast<std::size_t>(order_[i])] = leaf_count();
  leaves_.push_back({at, range.end});
  return true;
}

}  // namespace palpate
