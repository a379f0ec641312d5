#include "models/model/domain_guard.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate {
namespace {

// Radii in the normalised feature space, where a feature's spread is about 1.
// On held-out recordings of six materials the correction is better than the
// trend up to about 0.2 from the data and worse beyond; see tests/models.
constexpr double kInnerRadius = 0.08;
constexpr double kOuterToInner = 3.0;
constexpr double kFirstCoverRadius = 0.03;
constexpr double kCoverGrowth = 1.25;

std::vector<Eigen::Index> thinned(const Eigen::MatrixXd& sites, double radius) {
  std::vector<Eigen::Index> kept;
  const auto is_near = [&](const double* x, Eigen::Index other) {
    const double* point = sites.col(other).data();
    double squared = 0.0;
    for (Eigen::Index k = 0; k < sites.rows(); ++k) squared += (x[k] - point[k]) * (x[k] - point[k]);
    return squared <= radius * radius;
  };
  for (Eigen::Index i = 0; i < sites.cols(); ++i) {
    const double* x = sites.col(i).data();
    // Sites are in order of time, so that the newest kept points are the most likely to be near.
    if (std::any_of(kept.rbegin(), kept.rend(), [&](Eigen::Index other) { return is_near(x, other); })) continue;
    if (static_cast<Eigen::Index>(kept.size()) == kMaximumCoverPoints) return {};
    kept.push_back(i);
  }
  return kept;
}

}  // namespace

DomainCover make_cover(const Eigen::MatrixXd& sites) {
  double radius = kFirstCoverRadius;
  std::vector<Eigen::Index> kept = thinned(sites, radius);
  while (kept.empty()) {
    radius *= kCoverGrowth;
    kept = thinned(sites, radius);
  }
  DomainCover cover;
  cover.points = sites(Eigen::all, kept);
  // Every site has full trust, however much the cover was thinned.
  cover.inner_radius = std::max(kInnerRadius, 1.5 * radius);
  cover.outer_radius = kOuterToInner * cover.inner_radius;
  return cover;
}

DomainGuard::DomainGuard(const DomainCover& cover)
    : inner_radius_(cover.inner_radius),
      outer_radius_(cover.outer_radius),
      near_(cover.points, cover.inner_radius),
      nearest_(cover.points) {}

double DomainGuard::trust_at(double squared) const noexcept {
  if (squared <= inner_radius_ * inner_radius_) return 1.0;
  if (!(squared < outer_radius_ * outer_radius_)) return 0.0;
  const double t = (outer_radius_ - std::sqrt(squared)) / (outer_radius_ - inner_radius_);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace palpate
