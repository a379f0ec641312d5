#include "models/model/domain_guard.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "engine/tick/lanes.h"

namespace palpate {
namespace {

// Radii in the normalised feature space, where a feature's spread is about 1.
// On held-out recordings of six materials the correction is better than the
// trend up to about 0.2 from the data and worse beyond; see tests/models.
constexpr double kInnerRadius = 0.08;
constexpr double kOuterToInner = 3.0;
constexpr double kFirstCoverRadius = 0.03;
constexpr double kCoverGrowth = 1.25;

// One coordinate of as many points as are looked at together.
struct alignas(sizeof(V4)) Row {
  V4 first = V4{} + HUGE_VAL;
  V4 second = V4{} + HUGE_VAL;

  void set(std::size_t lane, double value) {
    // Not `(lane < kLanes ? first : second)[...]`: GCC 12 with sanitizers forgets that index.
    if (lane < kLanes) {
      first[lane] = value;
    } else {
      second[lane - kLanes] = value;
    }
  }
};
constexpr std::size_t kTogether = 2 * kLanes;

// Whether one of the points is near x, the newest first.
PALPATE_INLINE bool near_one_of(const std::vector<Row>& rows, std::size_t dimension, const double* x,
                                double squared) noexcept {
  for (std::size_t end = rows.size(); end > 0; end -= dimension) {
    const Row* row = rows.data() + end - dimension;
    V4 first{};
    V4 second{};
    for (std::size_t k = 0; k < dimension; ++k) {
      const V4 a = x[k] - row[k].first;
      const V4 b = x[k] - row[k].second;
      first += a * a;
      second += b * b;
    }
    const V4 least = first < second ? first : second;
    if (std::min(std::min(least[0], least[1]), std::min(least[2], least[3])) <= squared) return true;
  }
  return false;
}

bool near_one_narrow(const std::vector<Row>& rows, std::size_t dimension, const double* x, double squared) noexcept {
  return near_one_of(rows, dimension, x, squared);
}

#ifdef __x86_64__
[[gnu::target("avx2")]] bool near_one_wide(const std::vector<Row>& rows, std::size_t dimension, const double* x,
                                           double squared) noexcept {
  return near_one_of(rows, dimension, x, squared);
}
const auto kNearOne = has_wide_lanes() ? &near_one_wide : &near_one_narrow;
#else
const auto kNearOne = &near_one_narrow;
#endif

// Points of which one may be near another.
class Crowd {
 public:
  explicit Crowd(Eigen::Index dimension) : dimension_(static_cast<std::size_t>(dimension)) {}

  void add(const double* x) {
    if (count_ % kTogether == 0) rows_.resize(rows_.size() + dimension_);
    for (std::size_t k = 0; k < dimension_; ++k) rows_[rows_.size() - dimension_ + k].set(count_ % kTogether, x[k]);
    ++count_;
  }

  bool is_near(const double* x, double squared) const { return kNearOne(rows_, dimension_, x, squared); }

 private:
  std::size_t dimension_;
  std::size_t count_ = 0;
  std::vector<Row> rows_;
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
