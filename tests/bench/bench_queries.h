// How palpate-bench times an evaluation: one query at a time, each waiting for
// the last as ticks do.
#pragma once

#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "models/training/sites.h"

namespace palpate::bench {

// Walks over the columns of `points`; every query needs the last result.
template <typename Evaluate>
void run_queries(benchmark::State& state, const Eigen::MatrixXd& points, const Evaluate& evaluate) {
  std::array<double, kMaxFeatures> query{};
  Eigen::Index at = 0;
  double last = 0.0;
  for (auto _ : state) {
    const double* point = points.col(at).data();
    // Adds nothing, but the processor cannot know before `last` is there.
    for (Eigen::Index k = 0; k < points.rows(); ++k) query[static_cast<std::size_t>(k)] = point[k] + 1e-200 * last;
    last = evaluate(query.data());
    at = at + 1 < points.cols() ? at + 1 : 0;
  }
  benchmark::DoNotOptimize(last);
}

}  // namespace palpate::bench
