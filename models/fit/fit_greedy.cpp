#include "models/fit/choose_centres.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/random_stream.h"
#include "models/linear/lapack.h"
#include "models/solve/candidate_gains.h"
#include "models/solve/orthogonal_basis.h"

namespace palpate {
namespace {

// A strategy for the next centre. It adds the column of the centre to the basis and returns its site, or -1 if no
// candidate has a gain.
class Selection {
 public:
  Selection(const Sites& sites, const MethodRequest& request, std::vector<Eigen::Index> distinct)
      : gains_(sites, request.kernel), basis_(sites, request.kernel, request.centres), left_(std::move(distinct)) {}
  virtual ~Selection() = default;
  virtual Eigen::Index next() = 0;

 protected:
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

  CandidateGains gains_;
  OrthogonalBasis basis_;
  std::vector<Eigen::Index> left_;  // sites not chosen yet
};

class RandomSubsets final : public Selection {
 public:
  RandomSubsets(const Sites& sites, const MethodRequest& request, std::vector<Eigen::Index> distinct)
      : Selection(sites, request, std::move(distinct)), candidates_(request.candidates), random_(request.seed) {}

  Eigen::Index next() override {
    // If no site of a subset has a gain, another subset is drawn, up to five in all.
    for (int attempt = 0; attempt < 5 && !left_.empty(); ++attempt) {
      const std::size_t count = draw();
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

 private:
  // Brings a random subset to the front of left_; returns its size.
  std::size_t draw() {
    const std::size_t count = std::min(static_cast<std::size_t>(candidates_), left_.size());
    for (std::size_t j = 0; j < count; ++j)
      std::swap(left_[j], left_[j + static_cast<std::size_t>(random_.below(left_.size() - j))]);
    return count;
  }

  Eigen::Index candidates_;
  SplitMix64 random_;
};

class AllSites final : public Selection {
 public:
  AllSites(const Sites& sites, const MethodRequest& request, std::vector<Eigen::Index> distinct)
      : Selection(sites, request, std::move(distinct)), sites_(sites), kernel_(request.kernel) {
    gains_.update(left_, basis_);
  }

  Eigen::Index next() override {
    for (std::ptrdiff_t best = best_of(left_.size()); best >= 0; best = best_of(left_.size())) {
      const Eigen::Index site = left_[static_cast<std::size_t>(best)];
      const OrthogonalBasis::Outside part = basis_.outside(gains_.column(site));
      if (agrees(site, part)) {
        left_.erase(left_.begin() + best);
        accept(part);
        return site;
      }
      gains_.correct(site, part);
    }
    return -1;
  }

 private:
  // Whether the gain of the recurrence is accurate to 1 %, far below any difference in gain that matters.
  bool agrees(Eigen::Index site, const OrthogonalBasis::Outside& part) const {
    return gains_.useful(site, part) && part.correlation * part.correlation / part.squared >= 0.99 * gains_.gain(site);
  }

  void accept(const OrthogonalBasis::Outside& part) {
    const double residual_share = part.correlation / std::sqrt(part.squared);
    const Eigen::VectorXd q = basis_.add(part);
    gains_.advance(left_, basis_, kernel_product(kernel_, sites_.points, q.cwiseProduct(sites_.row_scale)),
                   residual_share);
  }

  const Sites& sites_;
  KernelKind kernel_;
};

bool select(Selection& selection, Eigen::Index count, const FitControl& control, std::vector<Eigen::Index>& chosen) {
  for (Eigen::Index step = 0; step < count; ++step) {
    if (!control.may_continue(0.95 * static_cast<double>(step) / static_cast<double>(count))) return false;
    const Eigen::Index site = selection.next();
    if (site < 0) break;
    chosen.push_back(site);
  }
  return true;
}

}  // namespace

Result<CentreSequence> choose_greedy(const Sites& sites, const MethodRequest& request, const FitControl& control) {
  if (const Status status = validate_sites(sites); !status) return status.error();
  const BlasThreads one_thread(1);
  std::vector<Eigen::Index> distinct = distinct_sites(sites);
  const auto available = static_cast<Eigen::Index>(distinct.size());
  const Eigen::Index first = distinct.front();
  MethodRequest clamped = request;
  clamped.centres = static_cast<int>(std::clamp<Eigen::Index>(request.centres, 0, available));
  std::vector<Eigen::Index> chosen;
  bool finished = false;
  if (request.candidates <= 0 || request.candidates >= available) {
    AllSites selection(sites, clamped, std::move(distinct));
    finished = select(selection, clamped.centres, control, chosen);
  } else {
    RandomSubsets selection(sites, clamped, std::move(distinct));
    finished = select(selection, clamped.centres, control, chosen);
  }
  if (!finished) return interrupted();
  if (chosen.empty() && clamped.centres > 0) chosen.push_back(first);  // a model file has at least one centre
  Eigen::MatrixXd centres(sites.dimension(), static_cast<Eigen::Index>(chosen.size()));
  for (Eigen::Index j = 0; j < centres.cols(); ++j)
    centres.col(j) = sites.points.col(chosen[static_cast<std::size_t>(j)]);
  CentreSequence sequence = CentreSequence::growing(std::move(centres));
  if (sequence.most < request.centres) {
    sequence.shortage =
        clamped.centres < request.centres ? "there are no more distinct sites" : "no other site lowers the error";
  }
  return sequence;
}

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
    .fit = fit_chosen,
    .choose = [](const MethodTask& task,
                 const FitControl& control) { return choose_greedy(task.sites, task.request, control); },
};

}  // namespace palpate
