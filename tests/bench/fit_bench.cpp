// Fits at the paper's number of sites, against N, and against the dimension.
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

// The cost over the dimension, as in figures 2 and 8 of the paper.
void against_dimension(const std::string& name, const Fit& fit) {
  for (int d = 1; d <= static_cast<int>(kMaxFeatures); ++d)
    add_made("dimension/" + name + "/" + std::to_string(d), 3, fit, d, kPaperSites);
}

// Grids with ten nodes a side, as in the paper, with all sites as centres. Seven and
// eight dimensions are left out: they would have 1e7 and 1e8 nodes.
void grid_against_dimension() {
  for (int d = 1; d <= 6; ++d)
    add_fit("dimension/grid_10_a_side/" + std::to_string(d), 1, [d](benchmark::State& state) {
      const Sites sites = made_sites(d, kPaperSites);
      const RbfFunction function{KernelKind::cubic, sites.points, sites.target_N, Eigen::VectorXd::Ones(1 + d)};
      TimedFit timed([&](const Sites& all, const Eigen::VectorXd&) -> Result<RbfFunction> {
        VoxelGrid grid = even_grid(all, std::vector<int>(static_cast<std::size_t>(d), 10));
        if (const Status filled = fill(grid, function); !filled) return filled.error();
        return RbfFunction{};
      });
      timed.run(state, sites, sites.target_N);
    });
}

void evaluate_rbf_in(benchmark::State& state) {
  const auto d = static_cast<int>(state.range(0));
  const Sites sites = made_sites(d, kCentres);
  const RbfCorrection evaluator({KernelKind::cubic, sites.points, sites.target_N, Eigen::VectorXd::Ones(1 + d)});
  run_queries(state, sites.points, [&](const double* x) { return evaluator.evaluate(x); });
}

void evaluate_grid_in(benchmark::State& state) {
  const auto d = static_cast<int>(state.range(0));
  const Sites sites = made_sites(d, kCentres);
  // Nodes a side for a grid of about the size of the second-level cache, or smaller.
  const int side[] = {1000, 100, 25, 11, 8, 6, 5, 4};
  VoxelGrid grid = even_grid(sites, std::vector<int>(static_cast<std::size_t>(d), side[d - 1]));
  (void)fill_grid(grid, [](const Eigen::MatrixXd& p, Eigen::VectorXd& out) { out = p.colwise().sum().transpose(); });
  const GridCorrection lookup(grid);
  run_queries(state, sites.points, [&](const double* x) { return lookup.evaluate(x); });
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
  against_dimension("random-100", random_fit);
  against_dimension("greedy-100_of_100", greedy_fit(100));
  grid_against_dimension();
  for (const auto& [name, function] :
       {std::pair{"dimension/evaluate_rbf", &evaluate_rbf_in}, std::pair{"dimension/evaluate_grid", &evaluate_grid_in}})
    benchmark::RegisterBenchmark(name, function)
        ->DenseRange(1, static_cast<int>(kMaxFeatures))
        ->Repetitions(5)
        ->MinTime(0.02)
        ->ReportAggregatesOnly();
  return 0;
}();

}  // namespace
}  // namespace palpate::bench
