// The greedy method: orthogonal forward selection, starting from the polynomial tail. Each step adds the site whose
// kernel column lowers the weighted squared error most, from a random subset of the sites or from all. A step costs
// O(N candidates basis) with random subsets, and O(N^2) with all sites (algebra.h).
// Source: Hoever & Harders (2009), section 4.2.3; Chen, Cowan & Grant (1991) for the orthogonal form.
#include <algorithm>
#include <span>
#include <vector>

#include "models/correction/algebra.h"
#include "models/correction/methods.h"
#include "models/linear/lapack.h"

namespace palpate {
namespace {

// If no site of a subset has a gain, another subset is drawn, up to this many in all.
constexpr int kMostSubsets = 5;

Result<FittedCorrection> fit_greedy(const MethodTask& task, const FitControl& control) {
  const Sites& sites = task.sites;
  const BlasThreads one_thread(1);
  std::vector<Eigen::Index> left = distinct_sites(sites);  // the sites that are not selected yet
  const Eigen::Index first = left.front();
  const auto most = std::clamp(task.centres, 0, static_cast<int>(left.size()));
  const bool all = task.candidates <= 0 || static_cast<std::size_t>(task.candidates) >= left.size();
  SplitMix64 random(task.seed);
  CandidateGains gains(sites);
  OrthogonalBasis basis(sites, most);
  const auto less = [&](Eigen::Index a, Eigen::Index b) { return gains.gain(a) < gains.gain(b); };
  std::vector<Eigen::Index> selected;
  int without_gain = 0;
  while (static_cast<int>(selected.size()) < most && without_gain < (all ? 1 : kMostSubsets)) {
    if (!control.may_continue(0.95 * static_cast<double>(selected.size()) / most)) return interrupted();
    const std::size_t count = all ? left.size() : draw_first(left, task.candidates, random);
    gains.update(std::span(left).first(count), basis);
    const auto best = std::max_element(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(count), less);
    if (!(gains.gain(*best) > 0.0)) {
      ++without_gain;
      continue;
    }
    without_gain = 0;
    if (basis.add(gains.columns({&*best, 1}))) selected.push_back(*best);
    left.erase(best);
  }
  if (selected.empty() && most > 0) selected.push_back(first);  // a model file has at least one centre
  return fit_centres(task, sites.points(Eigen::all, selected),
                     most < task.centres ? "there are no more distinct sites" : "no other site lowers the error");
}

}  // namespace

const Method kGreedyMethod{
    .name = "greedy",
    .colour = 0xD55E00,
    .takes = kTakesCentres | kTakesCandidates | kTakesKernel | kTakesSeed,
    .expected_seconds = 0.25,
    .fit = fit_greedy,
};

}  // namespace palpate
