// Fits at the paper's number of sites and against N.
#include <benchmark/benchmark.h>

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "models/correction/algebra.h"
#include "models/model/correction.h"
#include "tests/bench/bench.h"
#include "tests/support/fit_centres.h"

namespace palpate::bench {
namespace {

constexpr int kCentres = 100;

using Fit = std::function<Result<RbfFunction>(const Sites&, const Eigen::VectorXd& jnd_N)>;

Result<RbfFunction> random_fit(const Sites& sites, const Eigen::VectorXd&) {
  return test::fit_random(sites, {.centres = kCentres});
}

Result<RbfFunction> kdtree_fit(const Sites& sites, const Eigen::VectorXd& jnd_N) {
  return test::fit_kdtree(sites, jnd_N, {.centres = kCentres});
}

Fit greedy_fit(int candidates, int centres = kCentres) {
  return [=](const Sites& sites, const Eigen::VectorXd&) {
    return test::fit_greedy(sites, {.centres = centres, .candidates = candidates});
  };
}

Status fill(VoxelGrid& grid, const RbfFunction& function) {
  const RbfCorrection evaluator(function);
  return fill_grid(grid, [&](const Eigen::MatrixXd& p, Eigen::VectorXd& out) { evaluator.evaluate_many(p, out); });
}

Result<RbfFunction> direct_and_grid(const Sites& sites, const Eigen::VectorXd&) {
  Result<FittedCorrection> fitted = solve_direct(sites);
  if (!fitted) return fitted.error();
  VoxelGrid grid = even_grid(sites, {25, 11, 11, 11});
  if (const Status filled = fill(grid, fitted->function()); !filled) return filled.error();
  benchmark::DoNotOptimize(grid.values_N.data());
  return fitted->function();
}

// Times the fit alone. Memory is measured in a separate fit before: that returns all free memory
// to the system, so that page faults make this fit slower.
class TimedFit {
 public:
  explicit TimedFit(Fit fit) : fit_(std::move(fit)) {}

  void run(benchmark::State& state, const Sites& sites, const Eigen::VectorXd& jnd_N) {
    using Clock = std::chrono::steady_clock;
    if (!peak_bytes_) peak_bytes_ = peak_memory_of([&] { benchmark::DoNotOptimize(fit_(sites, jnd_N)); });
    for (auto _ : state) {
      const auto start = Clock::now();
      const Result<RbfFunction> fitted = fit_(sites, jnd_N);
      state.SetIterationTime(std::chrono::duration<double>(Clock::now() - start).count());
      if (!fitted) state.SkipWithError(fitted.error().message.c_str());
    }
    state.counters["peak_MB"] = 1e-6 * *peak_bytes_;
  }

 private:
  Fit fit_;
  std::optional<double> peak_bytes_;
};

using Benchmark = benchmark::internal::Benchmark;

// One fit for each repetition, in milliseconds.
Benchmark* in_single_fits(Benchmark* one, int repetitions) {
  return one->Repetitions(repetitions)->Iterations(1)->ReportAggregatesOnly()->Unit(benchmark::kMillisecond);
}

void add_fit(const std::string& name, int repetitions, std::function<void(benchmark::State&)> run) {
  in_single_fits(benchmark::RegisterBenchmark(name.c_str(), std::move(run)), repetitions)->UseManualTime();
}

void at_paper_size(const std::string& name, const Fit& fit, int repetitions) {
  add_fit("fit/" + name, repetitions, [timed = TimedFit(fit)](benchmark::State& state) mutable {
    timed.run(state, recorded_sites(), recorded_jnd_N());
  });
}

// A fit to `count` synthetic sites.
void add_made(const std::string& name, int repetitions, const Fit& fit, int dimension, Eigen::Index count) {
  add_fit(name, repetitions, [timed = TimedFit(fit), dimension, count](benchmark::State& state) mutable {
    const Sites sites = made_sites(dimension, count);
    timed.run(state, sites, sites.row_scale.cwiseInverse());
  });
}

void against_size(const std::string& name, const Fit& fit) {
  for (const int count : {1000, 10000, 100000, 1000000})
    add_made("size/" + name + "/" + std::to_string(count), count < 50000 ? 3 : 1, fit, 4, count);
}

const int registered = [] {
  at_paper_size("random-100", random_fit, 7);
  at_paper_size("kdtree-100", kdtree_fit, 7);
  at_paper_size("greedy-100_of_20", greedy_fit(20), 5);
  at_paper_size("greedy-100_of_100", greedy_fit(100), 5);
  at_paper_size("greedy-200_of_100", greedy_fit(100, 200), 3);
  at_paper_size("greedy-100_of_all", greedy_fit(0), 3);
  at_paper_size("direct+grid", direct_and_grid, 3);
  against_size("random-100", random_fit);
  against_size("kdtree-100", kdtree_fit);
  against_size("greedy-100_of_100", greedy_fit(100));
  return 0;
}();

}  // namespace
}  // namespace palpate::bench
