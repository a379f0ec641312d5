#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/base/text.h"
#include "scenes/report/paper.h"

namespace palpate {
namespace {

constexpr double kTickBudget_ns = 60e3;
// Ratios of two figures for the paper's words "almost identical" and "considerably lower".
constexpr double kAlmost = 1.1;
constexpr double kConsiderably = 0.8;
constexpr double kLargeForce_N = 2.5;  // the largest force of the paper's study
constexpr double kLinear = 1.3;        // the largest exponent that counts as linear

std::size_t bins_above(const PaperData& data, const PaperModel& model, double (*figure)(const PaperBin&)) {
  return static_cast<std::size_t>(std::count_if(model.bins.begin(), model.bins.end(), [&](const PaperBin& bin) {
    return figure(bin) > data.jnd.at(bin.force_N);
  }));
}

double spread(const PaperBin& bin) { return bin.mean_N + bin.std_N; }
double largest(const PaperBin& bin) { return bin.max_N; }

// Mean of `figure` over the bins for whose force `counts` is true.
double mean_of(const PaperModel& model, double (*figure)(const PaperBin&), const std::function<bool(double)>& counts) {
  double sum = 0.0;
  double count = 0.0;
  for (const PaperBin& bin : model.bins) {
    if (!counts(bin.force_N)) continue;
    sum += figure(bin);
    ++count;
  }
  return count > 0.0 ? sum / count : 0.0;
}

std::string of_bins(std::size_t above, const PaperModel& model) {
  return std::to_string(above) + " of " + std::to_string(model.bins.size()) + " bins above";
}

// Exponent of a power law through the last two points.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  if (n < 2) return 0.0;
  return std::log(y[n - 1] / y[n - 2]) / std::log(x[n - 1] / x[n - 2]);
}

// Adds a claim that is checked in each run.
using Answer = std::pair<std::string, bool>;
void add(std::vector<Claim>& claims, const PaperData& data, Claim claim,
         const std::function<Answer(const PaperRun&)>& answer) {
  for (const PaperRun& run : data.runs) {
    const auto [text, reproduced] = answer(run);
    claim.here.push_back(text);
    claim.reproduced.push_back(reproduced);
  }
  claims.push_back(std::move(claim));
}

// Adds a claim about times, which are measured once for all runs.
void add_once(std::vector<Claim>& claims, const PaperData& data, Claim claim, const std::string& text,
              bool reproduced) {
  claim.here.assign(data.runs.size(), "");
  claim.here.front() = text;
  claim.reproduced.assign(data.runs.size(), reproduced);
  claims.push_back(std::move(claim));
}

void add_accuracy(std::vector<Claim>& claims, const PaperData& data) {
  const auto always = [](double) { return true; };
  add(claims, data, {"random: at every force some samples err above the JND", "every force", {}, {}, ""},
      [&](const PaperRun& run) -> Answer {
        const PaperModel& model = run.models[kRandomCentres];
        const std::size_t above = bins_above(data, model, largest);
        return {of_bins(above, model), above == model.bins.size()};
      });
  for (const auto& [which, name] :
       {std::pair{kTreeCentres, "kD-tree"}, {kGreedy20, "greedy-20"}, {kGreedy100, "greedy-100"}}) {
    add(claims, data, {std::string(name) + ": mean plus deviation always below the JND", "0 bins above", {}, {}, ""},
        [&, which = which](const PaperRun& run) -> Answer {
          const std::size_t above = bins_above(data, run.models[which], spread);
          return {of_bins(above, run.models[which]), above == 0};
        });
  }
  add(claims, data, {"kD-tree is better than random, above all at large forces", "yes", {}, {}, ""},
      [&](const PaperRun& run) -> Answer {
        const auto large = [](double force_N) { return force_N > kLargeForce_N; };
        const double ratio =
            mean_of(run.models[kTreeCentres], spread, large) / mean_of(run.models[kRandomCentres], spread, large);
        return {three_digits(ratio) + " times the error above 2.5 N", ratio < 1.0};
      });
  add(claims, data, {"greedy-100 is almost as accurate as the interpolant", "almost identical", {}, {}, ""},
      [&](const PaperRun& run) -> Answer {
        const double ratio =
            mean_of(run.models[kGreedy100], spread, always) / mean_of(run.models[kGridOfAll], spread, always);
        return {three_digits(ratio) + " times mean plus deviation", ratio < kAlmost};
      });
  add(claims, data, {"20 and 100 candidates: mean plus deviation almost identical", "almost identical", {}, {}, ""},
      [&](const PaperRun& run) -> Answer {
        const double ratio =
            mean_of(run.models[kGreedy20], spread, always) / mean_of(run.models[kGreedy100], spread, always);
        return {three_digits(ratio) + " times", ratio < kAlmost && ratio > 1.0 / kAlmost};
      });
  add(claims, data, {"100 candidates: maxima at small forces considerably lower", "considerably lower", {}, {}, ""},
      [&](const PaperRun& run) -> Answer {
        const auto small = [](double force_N) { return force_N < 0.5; };
        const double ratio =
            mean_of(run.models[kGreedy100], largest, small) / mean_of(run.models[kGreedy20], largest, small);
        return {three_digits(ratio) + " times the maxima below 0.5 N", ratio < kConsiderably};
      });
  add(claims, data, {"the maxima exceed the JND for every method", "all", {}, {}, ""},
      [&](const PaperRun& run) -> Answer {
        std::size_t methods = 0;
        for (const PaperModel& model : run.models) methods += bins_above(data, model, largest) > 0 ? 1 : 0;
        return {std::to_string(methods) + " of " + std::to_string(run.models.size()) + " methods",
                methods == run.models.size()};
      });
}

void add_times(std::vector<Claim>& claims, const PaperData& data) {
  add(claims, data, {"samples after the reduction to 50 mN steps", "6,850", {}, {}, "another material and hand"},
      [](const PaperRun& run) -> Answer {
        return {with_thousands(std::to_string(run.sites)), true};
      });
  add(claims, data, {"one evaluation with 100 centres", "60 us", {}, {}, "a processor of today"},
      [](const PaperRun& run) -> Answer {
        const double time_ns = run.models[kGreedy100].time.evaluation.median_ns;
        return {three_digits(time_ns) + " ns; whole tick " + three_digits(run.models[kGreedy100].time.tick.median_ns) +
                    " ns",
                time_ns < kTickBudget_ns};
      });
  add(claims, data,
      {"time of a fit: random, kD-tree, greedy-20, greedy-100, grid", "4 s, 5 min, 9 min, 41 min, 50 min", {}, {}, ""},
      [](const PaperRun& run) -> Answer {
        std::string text;
        bool ordered = true;
        double before = 0.0;
        for (const PaperMethod which : {kRandomCentres, kTreeCentres, kGreedy20, kGreedy100, kGridOfAll}) {
          const double seconds = run.models[which].fit_seconds;
          text += (text.empty() ? "" : ", ") + three_digits(seconds) + " s";
          ordered = ordered && seconds > before;
          before = seconds;
        }
        return {text, ordered};
      });
  std::vector<double> sites;
  std::vector<std::vector<double>> seconds(kPaperMethods);
  for (const FitTimes& one : data.by_sites) {
    sites.push_back(static_cast<double>(one.sites));
    for (std::size_t i = 0; i < kPaperMethods; ++i) seconds[i].push_back(one.seconds[i]);
  }
  std::string linear;
  double steepest = 0.0;
  for (const PaperMethod which : {kRandomCentres, kTreeCentres, kGreedy20, kGreedy100}) {
    const double slope = exponent(sites, seconds[which]);
    steepest = std::max(steepest, slope);
    linear += (linear.empty() ? "exponents " : ", ") + fixed(slope, 2);
  }
  add_once(claims, data, {"cost of random, kD-tree and greedy is linear in the samples", "linear", {}, {}, ""}, linear,
           steepest < kLinear);
  const double cubic = exponent(sites, seconds[kGridOfAll]);
  add_once(claims, data,
           {"that of the interpolant grows with their third power", "3", {}, {}, "the grid's cost is in it"},
           "exponent " + fixed(cubic, 2), cubic > 2.0);
  const DimensionTimes& last = data.by_dimension.back();
  const DimensionTimes& before = data.by_dimension[data.by_dimension.size() - 2];
  add_once(
      claims, data,
      {"the grid's cost grows tenfold with each dimension of 10 nodes", "308 min in 6-D, solve 50 min", {}, {}, ""},
      three_digits(last.grid_s / before.grid_s) + " times from " + std::to_string(before.dimensions) + "-D to " +
          std::to_string(last.dimensions) + "-D: " + three_digits(last.grid_s) + " s, solve " +
          three_digits(last.solve_s) + " s",
      last.grid_s > 5.0 * before.grid_s);
}

}  // namespace

std::string run_name(const PaperRun& run) { return run.material + (run.fitted_times ? ", fitted times" : ""); }

std::vector<Claim> paper_claims(const PaperData& data) {
  std::vector<Claim> claims;
  add_accuracy(claims, data);
  const std::size_t of_accuracy = claims.size();
  add_times(claims, data);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const std::vector<bool>& runs = claims[i].reproduced;
    if (!claims[i].why.empty() || std::find(runs.begin(), runs.end(), false) == runs.end()) continue;
    claims[i].why =
        i < of_accuracy ? "not known: the paper's recordings are not public" : "another program on another processor";
  }
  return claims;
}

}  // namespace palpate
