#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "scenes/report/paper.h"

namespace palpate {
namespace {

constexpr double kTickBudget_ns = 60e3;
// Ratios of two figures for the paper's words "almost identical" and "considerably lower".
constexpr double kAlmost = 1.1;
constexpr double kConsiderably = 0.8;
constexpr double kLargeForce_N = 2.5;  // the largest force of the paper's study
constexpr double kSmallForce_N = 0.5;
constexpr double kLinear = 1.3;  // the largest exponent that counts as linear

double spread(const ForceBin& bin) { return bin.error_N.mean() + bin.error_N.deviation(); }
double largest(const ForceBin& bin) { return bin.error_N.largest(); }

std::size_t bins_above(const PaperData& data, const PaperModel& model, double (*figure)(const ForceBin&)) {
  return static_cast<std::size_t>(std::ranges::count_if(
      model.errors.bins, [&](const ForceBin& bin) { return figure(bin) > data.jnd.at(bin.force_N.mean()); }));
}

// The ratio of two methods' means of `figure` over the bins with forces between two values.
double ratio(const PaperRun& run, PaperMethod one, PaperMethod other, double (*figure)(const ForceBin&),
             double from_N = 0.0, double to_N = 1e300) {
  double sums[2] = {};
  for (const PaperMethod which : {one, other}) {
    for (const ForceBin& bin : run.models[which].errors.bins) {
      const double force_N = bin.force_N.mean();
      if (force_N > from_N && force_N < to_N) sums[which == one ? 0 : 1] += figure(bin);
    }
  }
  return sums[0] / sums[1];
}

std::string of_bins(std::size_t above, const PaperModel& model) {
  return std::to_string(above) + " of " + std::to_string(model.errors.bins.size()) + " bins above";
}

class Claims {
 public:
  explicit Claims(const PaperData& data) : data_(data) {}

  std::vector<Claim> all() {
    add_accuracy();
    remark("not known: the paper's recordings are not public");
    add_times();
    remark("another program on another processor");
    return std::move(claims_);
  }

 private:
  // Adds a claim that is checked in each run by `result`, a function of the run.
  template <typename Check>
  void add(Claim claim, const Check& result) {
    for (const PaperRun& run : data_.runs) claim.here.push_back(result(run));
    claims_.push_back(std::move(claim));
  }
  // Adds a claim about times, which are measured once for all runs.
  void add_once(Claim claim, const std::string& text, bool reproduced) {
    claim.here.assign(data_.runs.size(), {"", reproduced});
    claim.here.front().text = text;
    claims_.push_back(std::move(claim));
  }
  // Sets this remark on all claims that are not reproduced and have no remark yet.
  void remark(const char* why) {
    for (Claim& claim : claims_) {
      const bool all = std::ranges::all_of(claim.here, &Claim::Result::reproduced);
      if (!all && claim.why.empty()) claim.why = why;
    }
  }

  void add_accuracy() {
    add({"random: at every force some samples err above the JND", "every force"}, [&](const PaperRun& run) {
      const PaperModel& model = run.models[kRandomCentres];
      const std::size_t above = bins_above(data_, model, largest);
      return Claim::Result{of_bins(above, model), above == model.errors.bins.size()};
    });
    for (const auto& [which, name] :
         {std::pair{kTreeCentres, "kD-tree"}, {kGreedy20, "greedy-20"}, {kGreedy100, "greedy-100"}}) {
      add({std::string(name) + ": mean plus deviation always below the JND", "0 bins above"},
          [&, which = which](const PaperRun& run) {
            const std::size_t above = bins_above(data_, run.models[which], spread);
            return Claim::Result{of_bins(above, run.models[which]), above == 0};
          });
    }
    add({"kD-tree is better than random, above all at large forces", "yes"}, [](const PaperRun& run) {
      const double share = ratio(run, kTreeCentres, kRandomCentres, spread, kLargeForce_N);
      return Claim::Result{three_digits(share) + " times the error above 2.5 N", share < 1.0};
    });
    add({"greedy-100 is almost as accurate as the interpolant", "almost identical"}, [](const PaperRun& run) {
      const double share = ratio(run, kGreedy100, kGridOfAll, spread);
      return Claim::Result{three_digits(share) + " times mean plus deviation", share < kAlmost};
    });
    add({"20 and 100 candidates: mean plus deviation almost identical", "almost identical"}, [](const PaperRun& run) {
      const double share = ratio(run, kGreedy20, kGreedy100, spread);
      return Claim::Result{three_digits(share) + " times", share < kAlmost && share > 1.0 / kAlmost};
    });
    add({"100 candidates: maxima at small forces considerably lower", "considerably lower"}, [](const PaperRun& run) {
      const double share = ratio(run, kGreedy100, kGreedy20, largest, 0.0, kSmallForce_N);
      return Claim::Result{three_digits(share) + " times the maxima below 0.5 N", share < kConsiderably};
    });
    add({"the maxima exceed the JND for every method", "all"}, [&](const PaperRun& run) {
      std::size_t methods = 0;
      for (const PaperModel& model : run.models) methods += bins_above(data_, model, largest) > 0 ? 1 : 0;
      return Claim::Result{std::to_string(methods) + " of " + std::to_string(run.models.size()) + " methods",
                           methods == run.models.size()};
    });
  }

  void add_times() {
    add({"samples after the reduction to 50 mN steps", "6,850", "another material and hand"}, [](const PaperRun& run) {
      return Claim::Result{with_thousands(std::to_string(run.sites)), true};
    });
    add({"one evaluation with 100 centres", "60 us", "a processor of today"}, [](const PaperRun& run) {
      const ModelTiming& time = run.models[kGreedy100].time;
      return Claim::Result{
          three_digits(time.evaluation.median_ns) + " ns; whole tick " + three_digits(time.tick.median_ns) + " ns",
          time.evaluation.median_ns < kTickBudget_ns};
    });
    add({"time of a fit: random, kD-tree, greedy-20, greedy-100, grid", "4 s, 5 min, 9 min, 41 min, 50 min"},
        [](const PaperRun& run) {
          Claim::Result result{"", true};
          double before = 0.0;
          for (const PaperMethod which : {kRandomCentres, kTreeCentres, kGreedy20, kGreedy100, kGridOfAll}) {
            const double seconds = run.models[which].fit_seconds;
            result.text += (result.text.empty() ? "" : ", ") + three_digits(seconds) + " s";
            result.reproduced = result.reproduced && seconds > before;
            before = seconds;
          }
          return result;
        });
    // Exponent of a power law through the last two numbers of sites.
    const FitTimes& most = data_.by_sites.back();
    const FitTimes& fewer = data_.by_sites[data_.by_sites.size() - 2];
    const auto exponent = [&](PaperMethod which) {
      return std::log(most.seconds[which] / fewer.seconds[which]) /
             std::log(static_cast<double>(most.sites) / static_cast<double>(fewer.sites));
    };
    std::string linear;
    double steepest = 0.0;
    for (const PaperMethod which : {kRandomCentres, kTreeCentres, kGreedy20, kGreedy100}) {
      const double slope = exponent(which);
      steepest = std::max(steepest, slope);
      linear += (linear.empty() ? "exponents " : ", ") + fixed(slope, 2);
    }
    add_once({"cost of random, kD-tree and greedy is linear in the samples", "linear"}, linear, steepest < kLinear);
    const double cubic = exponent(kGridOfAll);
    add_once({"that of the interpolant grows with their third power", "3", "the grid's cost is in it"},
             "exponent " + fixed(cubic, 2), cubic > 2.0);
    const DimensionTimes& last = data_.by_dimension.back();
    const DimensionTimes& before = data_.by_dimension[data_.by_dimension.size() - 2];
    add_once({"the grid's cost grows tenfold with each dimension of 10 nodes", "308 min in 6-D, solve 50 min"},
             three_digits(last.grid_s / before.grid_s) + " times from " + std::to_string(before.dimensions) + "-D to " +
                 std::to_string(last.dimensions) + "-D: " + three_digits(last.grid_s) + " s, solve " +
                 three_digits(last.solve_s) + " s",
             last.grid_s > 5.0 * before.grid_s);
  }

  const PaperData& data_;
  std::vector<Claim> claims_;
};

}  // namespace

std::string run_name(const PaperRun& run) { return run.material + (run.fitted_times ? ", fitted times" : ""); }

std::vector<Claim> paper_claims(const PaperData& data) { return Claims(data).all(); }

}  // namespace palpate
