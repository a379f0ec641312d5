// The leaves of a kD-tree over sites: disjoint sets, each of which can be split at the median of its widest dimension.
// Thread guarantee: one object, one thread.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace palpate {

class SiteTree {
 public:
  // One leaf with all points. `points`: d x N, N >= 1; must outlive this.
  explicit SiteTree(const Eigen::MatrixXd& points);

  Eigen::Index leaf_count() const { return static_cast<Eigen::Index>(leaves_.size()); }
  Eigen::Index leaf_of(Eigen::Index site) const { return leaf_of_[static_cast<std::size_t>(site)]; }
  Eigen::VectorXd barycentre(Eigen::Index leaf) const;
  // Splits a leaf at the boundary between different coordinates nearest to the median. The lower part keeps the index,
  // the upper one gets leaf_count(). Returns false, without a change, if all points of the leaf are equal.
  bool split(Eigen::Index leaf);

 private:
  struct Leaf {
    std::size_t begin = 0;
    std::size_t end = 0;
  };
  const Eigen::MatrixXd& points_;
  std::vector<Eigen::Index> order_;  // sites, leaf by leaf
  std::vector<Leaf> leaves_;
  std::vector<Eigen::Index> leaf_of_;
};

}  // namespace palpate
