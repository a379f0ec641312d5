#pragma once

#include <benchmark/benchmark.h>
#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>

#include "engine/tick/features.h"
#include "models/correction/methods.h"
#include "models/fit/fit.h"
#include "models/model/correction.h"

namespace palpate::bench {
// The data of palpate-bench: one recording of the virtual silicone block, and
// smooth synthetic sites where their number or dimension varies. Made once,
// deterministic.
// The number of sites of Hoever & Harders (2009).
inline constexpr Eigen::Index kPaperSites = 6850;

// The prepared recording: about 7,000 sites, four features.
const PreparedTraining& recorded();
// kPaperSites of its sites, evenly spread in time, and their thresholds.
const Sites& recorded_sites();
const Eigen::VectorXd& recorded_jnd_N();
// `centres` of these sites with random weights.
RbfFunction recorded_function(Eigen::Index centres);

// A smooth force at random points with 5 mN of noise; thresholds are 1 / row_scale.
Sites made_sites(int dimension, Eigen::Index count);

// Equally spaced nodes over the sites' bounding box.
VoxelGrid even_grid(const Sites& sites, const std::vector<int>& sizes);

// Peak memory during `work` minus memory in use before, in bytes; 0 if the
// system does not report it.
double peak_memory_of(const std::function<void()>& work);

// Times evaluations for palpate-bench: one query at a time, each depending on the
// previous result, as in ticks.
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

// The tables of tests/bench/README.md in Markdown, from the rows that were run.
struct BenchRow {
  double seconds = 0.0;  // median
  std::map<std::string, double> counters;
  std::string label;
};

using BenchRows = std::map<std::string, BenchRow>;  // by name, e.g. "fit/random-100"

// Three digits and a unit: "78.1 ns".
std::string duration(double seconds);

// Prints a table to stdout for each group with at least one row.
void print_tables(const BenchRows& rows);

}  // namespace palpate::bench
