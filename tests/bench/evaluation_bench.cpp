// Evaluation, one query at a time, each depending on the previous result, as in ticks.
#include <benchmark/benchmark.h>

#include <array>
#include <memory>
#include <string>

#include "models/model/fitted_model.h"
#include "models/model/grid/voxel_grid.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/model/rbf/rbf_simd.h"
#include "models/solve/fill_grid.h"
#include "tests/bench/bench_data.h"
#include "tests/bench/bench_queries.h"
#include "tests/bench/scalar_loop.h"

namespace palpate::bench {
namespace {

constexpr int kRepetitions = 7;
constexpr double kSeconds = 0.05;  // per repetition

void scalar_loop(benchmark::State& state) {
  const RbfFunction f = recorded_function(state.range(0));
  run_queries(state, recorded_sites().points, [&](const double* x) {
    return scalar_cubic_4d(f.centres.data(), f.weights.data(), static_cast<std::size_t>(f.centre_count()),
                           f.tail.data(), x);
  });
}

void rbf(benchmark::State& state) {
  const RbfCorrection evaluator(recorded_function(state.range(0)));
  run_queries(state, recorded_sites().points, [&](const double* x) { return evaluator.evaluate(x); });
}

void rbf_on_target(benchmark::State& state, const std::string& target) {
  simd::choose_target(target);
  const RbfCorrection evaluator(recorded_function(state.range(0)));
  simd::choose_target("");
  run_queries(state, recorded_sites().points, [&](const double* x) { return evaluator.evaluate(x); });
}

void rbf_of_kernel(benchmark::State& state, KernelKind kernel) {
  RbfFunction function = recorded_function(100);
  function.kernel = kernel;
  function.tail = Eigen::VectorXd::Ones(tail_size(tail_degree(kernel), 4));
  const RbfCorrection evaluator(function);
  run_queries(state, recorded_sites().points, [&](const double* x) { return evaluator.evaluate(x); });
}

// Weights and queries in the denormal range must not take more time.
void rbf_denormal(benchmark::State& state) {
  RbfFunction function = recorded_function(100);
  function.weights *= 1e-310;
  function.centres *= 1e-310;
  const RbfCorrection evaluator(function);
  const Eigen::MatrixXd points = 1e-310 * recorded_sites().points;
  run_queries(state, points, [&](const double* x) { return evaluator.evaluate(x); });
}

void voxel(benchmark::State& state) {
  VoxelGrid grid = even_grid(recorded_sites(), {25, 11, 11, 11});
  const RbfCorrection evaluator(recorded_function(100));
  (void)fill_grid(grid, [&](const Eigen::MatrixXd& p, Eigen::VectorXd& out) { evaluator.evaluate_many(p, out); });
  const GridCorrection lookup(grid);
  run_queries(state, recorded_sites().points, [&](const double* x) { return lookup.evaluate(x); });
}

void whole_model(benchmark::State& state, const Method* method) {
  MethodRequest request;
  request.method = method;
  const Result<MethodFit> fit = fit_method(recorded(), request);
  if (!fit) return state.SkipWithError(fit.error().message.c_str());
  const FittedModel model(fit->data);
  const auto& judged = recorded().set.evaluation_features;
  std::size_t at = 0;
  double last = 0.0;
  for (auto _ : state) {
    std::array<double, kMaxFeatures> features = judged[at];
    features[0] += 1e-200 * last;
    last = model.evaluate(features.data()).force_N;
    at = at + 1 < judged.size() ? at + 1 : 0;
  }
  benchmark::DoNotOptimize(last);
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
  prepare(benchmark::RegisterBenchmark("evaluate/rbf_denormal", rbf_denormal));
  prepare(benchmark::RegisterBenchmark("evaluate/voxel_25x11x11x11", voxel));
  for (const KernelKind kernel : kKernelKinds)
    prepare(benchmark::RegisterBenchmark(("evaluate/kernel/" + std::string(kernel_name(kernel))).c_str(), rbf_of_kernel,
                                         kernel));
  for (const Method* method : methods())
    prepare(benchmark::RegisterBenchmark(("evaluate/model/" + std::string(method->name)).c_str(), whole_model, method));
  for (const std::string& target : simd::target_names())
    prepare(benchmark::RegisterBenchmark(("evaluate/target/" + target).c_str(), rbf_on_target, target)
                ->Arg(100)
                ->Arg(6850));
  return 0;
}();

}  // namespace
}  // namespace palpate::bench
