// The centres of a method for every number of centres up to a maximum, for methods whose selections are nested: greedy
// and random add one centre a step, the kD-tree replaces one by two.
// Thread guarantee: value type.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace palpate {

struct CentreSequence {
  // The index of a centre within a selection, and the numbers of centres whose selection contains it.
  struct Membership {
    Eigen::Index place = 0;
    Eigen::Index from = 1;
    Eigen::Index until = 0;  // first number of centres without it; 0: none
  };

  Eigen::MatrixXd pool;                 // d x m, the centres of all selections, each once, in order of appearance
  std::vector<Membership> memberships;  // one for each column of `pool`
  Eigen::Index most = 0;                // maximum number of centres
  std::string shortage;                 // why `most` is less than requested; else empty

  // The columns of `pool` of the selection of `count` centres (0 to `most`), in the order of their indices.
  std::vector<Eigen::Index> columns_of(Eigen::Index count) const {
    std::vector<Eigen::Index> columns(static_cast<std::size_t>(count));
    for (std::size_t j = 0; j < memberships.size(); ++j) {
      const Membership& membership = memberships[j];
      if (membership.from <= count && (membership.until == 0 || count < membership.until)) {
        columns[static_cast<std::size_t>(membership.place)] = static_cast<Eigen::Index>(j);
      }
    }
    return columns;
  }
  Eigen::MatrixXd centres_of(Eigen::Index count) const { return pool(Eigen::all, columns_of(count)); }

  // A sequence in which each centre is added after those before it and stays.
  static CentreSequence growing(Eigen::MatrixXd centres) {
    CentreSequence sequence{std::move(centres), {}, 0, ""};
    sequence.most = sequence.pool.cols();
    for (Eigen::Index j = 0; j < sequence.most; ++j) sequence.memberships.push_back({j, j + 1, 0});
    return sequence;
  }
};

}  // namespace palpate
