// The leaves of a kD-tree over sites: disjoint sets that can be split at the
// median of their widest dimension.
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
  // Mean of the leaf's points.
  Eigen::VectorXd barycentre(Eigen::Index leaf) const;
  // Splits in two halves, ties moved so that equal coordinates stay together:
  // the lower half keeps the number, the upper one gets leaf_count(). False,
  // and nothing done, when all points of the leaf are the same.
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
