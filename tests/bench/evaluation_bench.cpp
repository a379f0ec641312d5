// Evaluation, one query at a time, each depending on the previous result, as in ticks.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "models/model/correction.h"
#include "models/model/fitted_model.h"
#include "tests/bench/bench.h"

namespace palpate::bench {
namespace {

constexpr int kRepetitions = 7;
constexpr double kSeconds = 0.05;  // per repetition

// Eq. 2 in a plain loop over 4-D centres with the cubic kernel,
//   sum_j weights[j] |x - centre_j|^3 + tail[0] + sum_k tail[1 + k] x[k].
// Ratios to this reference, compiled with -O2 (CMakeLists.txt), are comparable between machines.
[[gnu::noinline]] double scalar_cubic_4d(const RbfFunction& f, const double* x) {
  const double* centres = f.centres.data();
  double sum = f.tail[0];
  for (Eigen::Index k = 0; k < 4; ++k) sum += f.tail[1 + k] * x[k];
  for (Eigen::Index j = 0; j < f.centre_count(); ++j) {
    double squared = 0.0;
    for (Eigen::Index k = 0; k < 4; ++k) {
      const double difference = x[k] - centres[4 * j + k];
      squared += difference * difference;
    }
    sum += f.weights[j] * squared * std::sqrt(squared);
  }
  return sum;
}

void scalar_loop(benchmark::State& state) {
  const RbfFunction function = recorded_function(state.range(0));
  run_queries(state, recorded_sites().points, [&](const double* x) { return scalar_cubic_4d(function, x); });
}

void rbf(benchmark::State& state) {
  const RbfCorrection evaluator(recorded_function(state.range(0)));
  run_queries(state, recorded_sites().points, [&](const double* x) { return evaluator.evaluate(x); });
}

void voxel(benchmark::State& state) {
  VoxelGrid grid = even_grid(recorded_sites(), {25, 11, 11, 11});
  const RbfCorrection evaluator(recorded_function(100));
  (void)fill_grid(grid, [&](const Eigen::MatrixXd& p, Eigen::VectorXd& out) { evaluator.evaluate_many(p, out); });
  const GridCorrection lookup(grid);
  run_queries(state, recorded_sites().points, [&](const double* x) { return lookup.evaluate(x); });
}

void whole_model(benchmark::State& state, const Method* method) {
  const Result<MethodFit> fit = fit_method(recorded(), {.method = method, .features = FeatureChoice::scene});
  if (!fit) return state.SkipWithError(fit.error().message.c_str());
  const FittedModel& model = *fit->model;
  run_queries(state, recorded().features, [&](const double* x) { return model.force(x); });
}

void prepare(benchmark::internal::Benchmark* one) {
  one->Repetitions(kRepetitions)->MinTime(kSeconds)->ReportAggregatesOnly();
}

void at_sizes(benchmark::internal::Benchmark* one) {
  for (const int centres : {100, 500, 1000, 6850}) one->Arg(centres);
  prepare(one);
}

const int registered = [] {
  at_sizes(benchmark::RegisterBenchmark("evaluate/scalar", scalar_loop));
  at_sizes(benchmark::RegisterBenchmark("evaluate/rbf", rbf));
  prepare(benchmark::RegisterBenchmark("evaluate/voxel_25x11x11x11", voxel));
  for (const Method* method : methods())
    prepare(benchmark::RegisterBenchmark(("evaluate/model/" + std::string(method->name)).c_str(), whole_model, method));
  return 0;
}();

}  // namespace
}  // namespace palpate::bench
