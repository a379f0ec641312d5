// How much each candidate centre would lower the squared error, given the
// basis chosen so far: (c . r)^2 / |c'|^2, where c is the candidate's scaled
// kernel column, c' its part outside the basis and r the residual.
//
// |c'|^2 = |c|^2 - |Q^T c|^2 loses all its digits when c lies almost inside
// the basis; where less than 1e-8 of |c|^2 is left it is computed from c'
// itself, and a candidate with |c'| <= 1e-10 |c| has no gain.
// Thread guarantee: one object, one thread; it starts others itself.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/orthogonal_basis.h"
#include "models/rbf_evaluate.h"

namespace palpate {

struct CandidateParts {
  Eigen::VectorXd length_squared;   // |c|^2
  Eigen::VectorXd outside_squared;  // |c'|^2, 0 when the candidate is of no use
  Eigen::VectorXd correlation;      // c . r
};

inline constexpr double kCancelled = 1e-8;      // of a square: recompute below this
inline constexpr double kInsideBasis = 1e-20;   // of a square: no use below this

class CandidateGains {
 public:
  CandidateGains(const Sites& sites, KernelKind kernel);

  // The scaled kernel column of a centre at a site, N values.
  Eigen::VectorXd column(Eigen::Index site) const;
  // The three quantities for some candidate sites. O(N candidates basis).
  CandidateParts evaluate(const std::vector<Eigen::Index>& candidates, const OrthogonalBasis& basis) const;
  const PointArrays& points() const { return points_; }

 private:
  void evaluate_batch(const std::vector<Eigen::Index>& candidates, Eigen::Index first, Eigen::Index count,
                      const OrthogonalBasis& basis, CandidateParts& out) const;
  void recompute(Eigen::Index site, Eigen::Index at, const OrthogonalBasis& basis, CandidateParts& out) const;

  const Sites& sites_;
  KernelKind kernel_;
  PointArrays points_;
};

}  // namespace palpate
