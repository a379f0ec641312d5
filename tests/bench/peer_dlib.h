// Training data and functions of both dlib peers.
#pragma once

#include <dlib/matrix.h>

#include <utility>
#include <vector>

#include "models/training/sites.h"
#include "tests/bench/peer.h"

namespace palpate::bench {

using DlibSample = dlib::matrix<double, 0, 1>;

inline std::vector<DlibSample> dlib_samples(const Sites& sites) {
  const long d = sites.dimension();
  std::vector<DlibSample> samples;
  for (Eigen::Index i = 0; i < sites.count(); ++i) {
    DlibSample sample(d);
    for (long k = 0; k < d; ++k) sample(k) = sites.points(k, i);
    samples.push_back(std::move(sample));
  }
  return samples;
}

// The trained object as a function of a feature vector.
template <typename Trained>
Function dlib_function(Trained trained, long dimension) {
  return [trained = std::move(trained), query = DlibSample(dimension)](const double* x) mutable {
    for (long k = 0; k < query.size(); ++k) query(k) = x[k];
    return trained(query);
  };
}

}  // namespace palpate::bench
