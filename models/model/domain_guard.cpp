#include "models/model/domain_guard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
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

// Points of which one may be near another, a block of them at a time.
class Crowd {
 public:
  explicit Crowd(Eigen::Index dimension) : dimension_(static_cast<std::size_t>(dimension)) {}

  void add(const double* x) {
    if (count_ % kBlock == 0) coordinates_.resize(coordinates_.size() + kBlock * dimension_, HUGE_VAL);
    double* block = coordinates_.data() + count_ / kBlock * kBlock * dimension_;
    for (std::size_t k = 0; k < dimension_; ++k) block[k * kBlock + count_ % kBlock] = x[k];
    ++count_;
  }

  // The newest are asked first.
  bool is_near(const double* x, double squared) const {
    for (std::size_t end = coordinates_.size(); end > 0; end -= kBlock * dimension_) {
      const double* block = coordinates_.data() + end - kBlock * dimension_;
      std::array<double, kBlock> sums{};
      for (std::size_t k = 0; k < dimension_; ++k) {
        for (std::size_t j = 0; j < kBlock; ++j) {
          const double difference = x[k] - block[k * kBlock + j];
          sums[j] += difference * difference;
        }
      }
      int near = 0;
      for (const double sum : sums) near += sum <= squared ? 1 : 0;
      if (near > 0) return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t kBlock = 8;

  std::size_t dimension_;
  std::size_t count_ = 0;
  std::vector<double> coordinates_;
};

std::vector<Eigen::Index> thinned(const Eigen::MatrixXd& sites, double radius) {
  std::vector<Eigen::Index> kept;
  Crowd crowd(sites.rows());
  for (Eigen::Index i = 0; i < sites.cols(); ++i) {
    // Sites come in the order of time: what covers one is most often new.
    if (crowd.is_near(sites.col(i).data(), radius * radius)) continue;
    if (static_cast<Eigen::Index>(kept.size()) == kMaximumCoverPoints) return {};
    kept.push_back(i);
    crowd.add(sites.col(i).data());
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
  // Every site keeps full trust, however thin the cover had to be.
  cover.inner_radius = std::max(kInnerRadius, 1.5 * radius);
  cover.outer_radius = kOuterToInner * cover.inner_radius;
  return cover;
}

DomainGuard::DomainGuard(DomainCover cover)
    : cover_(std::move(cover)),
      inner_squared_(cover_.inner_radius * cover_.inner_radius),
      near_(cover_.points, cover_.inner_radius),
      nearest_(cover_.points) {}

double DomainGuard::trust_at(double squared) const noexcept {
  if (squared <= inner_squared_) return 1.0;
  if (!(squared < cover_.outer_radius * cover_.outer_radius)) return 0.0;
  const double t = (cover_.outer_radius - std::sqrt(squared)) / (cover_.outer_radius - cover_.inner_radius);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace palpate
