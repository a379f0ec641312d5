// Times evaluations for palpate-bench: one query at a time, each depending on the
// previous result, as in ticks.
#pragma once

#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "engine/tick/features.h"
#include "models/correction/sites.h"

namespace palpate::bench {

// Evaluates the columns of `points` in turn; every query depends on the previous result.
template <typename Evaluate>
void run_queries(benchmark::State& state, const Eigen::MatrixXd& points, const Evaluate& evaluate) {
  std::array<double, kMaxFeatures> query{};
  Eigen::Index at = 0;
  double last = 0.0;
  for (auto _ : state) {
    const double* point = points.col(at).data();
    // Does not change the query, but makes it depend on `last`.
    for (Eigen::Index k = 0; k < points.rows(); ++k) query[static_cast<std::size_t>(k)] = point[k] + 1e-200 * last;
    last = evaluate(query.data());
    at = at + 1 < points.cols() ? at + 1 : 0;
  }
  benchmark::DoNotOptimize(last);
}

}  // namespace palpate::bench
