// The greedy method: orthogonal forward selection, starting from the polynomial tail. Each step adds the site whose
// kernel column lowers the weighted squared error most, from a random subset of the sites or from all.
//
// Random subsets cost O(N candidates basis) a step. With all sites, one product with the kernel matrix a step updates
// the squared norms and correlations of all columns (|c'|^2 -= (q.c)^2, c.r -= (q.r)(q.c)); it computes the kernels
// itself, so memory is O(N centres). Every selected column is orthogonalised explicitly before it is accepted.
// Source: Hoever & Harders (2009), section 4.2.3; Chen, Cowan & Grant (1991) for the orthogonal form.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "models/fit/methods.h"
#include "models/linear/lapack.h"
#include "models/solve/candidate_gains.h"
#include "models/solve/orthogonal_basis.h"

namespace palpate {
namespace {

class Selection {
 public:
  // `distinct`: the candidates.
  Selection(const Sites& sites, const MethodRequest& request, std::vector<Eigen::Index> distinct)
      : sites_(sites),
        kernel_(request.kernel),
        candidates_(request.candidates),
        all_(request.candidates <= 0 || static_cast<std::size_t>(request.candidates) >= distinct.size()),
        random_(request.seed),
        gains_(sites, request.kernel),
        basis_(sites, request.kernel, request.centres),
        left_(std::move(distinct)) {
    if (all_) gains_.update(left_, basis_);
  }

  // Adds the column of the next centre to the basis and returns its site, or -1 if no candidate has a gain.
  Eigen::Index next() { return all_ ? next_of_all() : next_of_subset(); }

 private:
  Eigen::Index next_of_subset() {
    // If no site of a subset has a gain, another subset is drawn, up to five in all.
    for (int attempt = 0; attempt < 5 && !left_.empty(); ++attempt) {
      const std::size_t count = draw_first(left_, candidates_, random_);
      gains_.update(std::span(left_).first(count), basis_);
      const std::ptrdiff_t best = best_of(count);
      if (best < 0) continue;
      const Eigen::Index site = left_[static_cast<std::size_t>(best)];
      basis_.add(basis_.outside(gains_.column(site)));
      left_.erase(left_.begin() + best);
      return site;
    }
    return -1;
  }

  Eigen::Index next_of_all() {
    for (std::ptrdiff_t best = best_of(left_.size()); best >= 0; best = best_of(left_.size())) {
      const Eigen::Index site = left_[static_cast<std::size_t>(best)];
      const OrthogonalBasis::Outside part = basis_.outside(gains_.column(site));
      // Whether the gain of the recurrence is accurate to 1 %, far below any difference in gain that matters.
      const bool agrees =
          gains_.useful(site, part) && part.correlation * part.correlation / part.squared >= 0.99 * gains_.gain(site);
      if (!agrees) {
        gains_.correct(site, part);
        continue;
      }
      left_.erase(left_.begin() + best);
      const Eigen::VectorXd q = basis_.add(part);
      gains_.advance(left_, basis_, kernel_product(kernel_, sites_.points, q.cwiseProduct(sites_.row_scale)),
                     part.correlation / std::sqrt(part.squared));
      return site;
    }
    return -1;
  }

  // The index of the largest gain among the first `count` sites left, the first of equal ones; -1 if none is positive.
  std::ptrdiff_t best_of(std::size_t count) const {
    std::ptrdiff_t best = -1;
    double best_gain = 0.0;
    for (std::size_t j = 0; j < count; ++j)
      if (const double gain = gains_.gain(left_[j]); gain > best_gain) {
        best_gain = gain;
        best = static_cast<std::ptrdiff_t>(j);
      }
    return best;
  }

  const Sites& sites_;
  KernelKind kernel_;
  Eigen::Index candidates_;  // a subset
  bool all_;
  SplitMix64 random_;
  CandidateGains gains_;
  OrthogonalBasis basis_;
  std::vector<Eigen::Index> left_;  // sites not chosen yet
};

Result<CentreSequence> choose_greedy(const MethodTask& task, const FitControl& control) {
  const Sites& sites = task.sites;
  const BlasThreads one_thread(1);
  std::vector<Eigen::Index> distinct = distinct_sites(sites);
  const auto available = static_cast<int>(distinct.size());
  const Eigen::Index first = distinct.front();
  MethodRequest request = task.request;
  request.centres = std::clamp(request.centres, 0, available);
  Selection selection(sites, request, std::move(distinct));
  std::vector<Eigen::Index> chosen;
  for (int step = 0; step < request.centres; ++step) {
    if (!control.may_continue(0.95 * step / request.centres)) return interrupted();
    const Eigen::Index site = selection.next();
    if (site < 0) break;
    chosen.push_back(site);
  }
  if (chosen.empty() && request.centres > 0) chosen.push_back(first);  // a model file has at least one centre
  CentreSequence sequence = CentreSequence::growing(sites.points(Eigen::all, chosen));
  if (sequence.most() < task.request.centres) {
    sequence.shortage =
        request.centres < task.request.centres ? "there are no more distinct sites" : "no other site lowers the error";
  }
  return sequence;
}

}  // namespace

const Method kGreedyMethod{
    .name = "greedy",
    .label = "greedy",
    .colour = 0xD55E00,
    .takes = kTakesCentres | kTakesCandidates | kTakesKernel | kTakesSeed,
    .expected_seconds =
        [](const MethodRequest& request) {
          const double hundreds = 0.01 * request.centres;
          return 0.1 + (0.05 + 0.001 * request.candidates) * hundreds * hundreds;
        },
    .choose = choose_greedy,
};

}  // namespace palpate
