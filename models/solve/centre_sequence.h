// The centres that a method takes for every number of them up to a largest, of a
// method whose choice for k goes on to k + 1: greedy and random add one centre, the
// kD-tree puts two in the place of one.
// Thread guarantee: a value type.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace palpate {

struct CentreSequence {
  // Where a centre stands among those of a count, and the counts that have it.
  struct Stay {
    Eigen::Index place = 0;
    Eigen::Index from = 1;
    Eigen::Index until = 0;  // the first count without it; 0: it stays
  };

  Eigen::MatrixXd pool;     // d x m, each centre of any count once, as they come in
  std::vector<Stay> stays;  // m
  Eigen::Index most = 0;    // the largest count there is
  std::string shortage;     // why there are no more than `most`; empty: no more were asked for

  // Columns of `pool` that `count` (0 to most) has, by place.
  std::vector<Eigen::Index> columns_of(Eigen::Index count) const {
    std::vector<Eigen::Index> columns(static_cast<std::size_t>(count));
    for (std::size_t j = 0; j < stays.size(); ++j) {
      const Stay& stay = stays[j];
      if (stay.from <= count && (stay.until == 0 || count < stay.until)) {
        columns[static_cast<std::size_t>(stay.place)] = static_cast<Eigen::Index>(j);
      }
    }
    return columns;
  }
  Eigen::MatrixXd centres_of(Eigen::Index count) const { return pool(Eigen::all, columns_of(count)); }

  // Of centres that come in one by one and stay.
  static CentreSequence growing(Eigen::MatrixXd centres) {
    CentreSequence sequence{std::move(centres), {}, 0, ""};
    sequence.most = sequence.pool.cols();
    for (Eigen::Index j = 0; j < sequence.most; ++j) sequence.stays.push_back({j, j + 1, 0});
    return sequence;
  }
};

}  // namespace palpate
