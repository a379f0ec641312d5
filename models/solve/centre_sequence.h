// The centres of a method for every number of centres up to a maximum, for methods whose selections are nested: greedy
// and random add one centre a step, the kD-tree replaces one by two.
// Thread guarantee: value type.
#pragma once

#include <Eigen/Core>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace palpate {

struct CentreSequence {
  Eigen::MatrixXd pool;  // d x m, the centres of all selections in order of appearance
  // The index of each column of `pool` within a selection. A later column replaces an earlier one with the same index.
  std::vector<Eigen::Index> places;
  Eigen::Index columns_a_step = 1;  // by which each centre after the first enlarges the pool
  std::string shortage;             // why most() is less than requested; else empty

  // The maximum number of centres.
  Eigen::Index most() const { return pool.cols() > 0 ? 1 + (pool.cols() - 1) / columns_a_step : 0; }
  // The columns of `pool` of the selection of `count` centres (0 to most()), in the order of their indices.
  std::vector<Eigen::Index> columns_of(Eigen::Index count) const {
    std::vector<Eigen::Index> columns(static_cast<std::size_t>(count));
    const Eigen::Index used = count > 0 ? 1 + columns_a_step * (count - 1) : 0;
    for (Eigen::Index j = 0; j < used; ++j) {
      columns[static_cast<std::size_t>(places[static_cast<std::size_t>(j)])] = j;
    }
    return columns;
  }
  Eigen::MatrixXd centres_of(Eigen::Index count) const { return pool(Eigen::all, columns_of(count)); }

  // A sequence in which each centre is added after those before it and stays.
  static CentreSequence growing(Eigen::MatrixXd centres) {
    CentreSequence sequence{std::move(centres), {}, 1, ""};
    sequence.places.resize(static_cast<std::size_t>(sequence.pool.cols()));
    std::iota(sequence.places.begin(), sequence.places.end(), Eigen::Index{0});
    return sequence;
  }
};

}  // namespace palpate
