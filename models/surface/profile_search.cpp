#include "models/surface/profile_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "models/surface/surface_numbers.h"

namespace palpate {
namespace {

constexpr double kLeastGain = 0.05;
constexpr double kLeastBlock = 0.1;  // of a mean block: smaller differences are noise
constexpr std::size_t kMostValleys = 4;
constexpr double kGolden = 0.6180339887498949;
constexpr int kBisections = 6;

double sum(const BlockCosts& costs) { return std::accumulate(costs.begin(), costs.end(), 0.0); }

bool as_good(const BlockCosts& one, const BlockCosts& best) {
  const auto count = static_cast<double>(one.size());
  const double difference = sum(one) - sum(best);
  if (difference <= kLeastGain * sum(best)) return true;
  // Every block has one voice, whatever it costs.
  const double least = kLeastBlock * sum(best) / count;
  double mean = 0.0;
  double squares = 0.0;
  for (std::size_t b = 0; b < one.size(); ++b) {
    const double share = (one[b] - best[b]) / (one[b] + best[b] + least);
    mean += share / count;
    squares += share * share;
  }
  return mean <= kSignificantErrors * std::sqrt((squares / count - mean * mean) / std::max(1.0, count - 1.0));
}

struct Place {
  double at = 0.0;
  BlockCosts costs;
};

class Search {
 public:
  Search(const std::function<BlockCosts(double)>& cost, const SearchRange& range) : cost_(cost), range_(range) {}

  Located run() {
    scan();
    const Place zero = place(0.0);
    if (range_.zero_suffices && std::all_of(scanned_.begin(), scanned_.end(),
                                            [&](const Place& one) { return as_good(zero.costs, one.costs); })) {
      return {0.0, false, kUnknownError, false, sum(zero.costs), sum(zero.costs)};
    }
    refine_valleys();
    // Outside of the range, where recordings do not overlap, a cost at 0 says nothing.
    const bool zero_counts = range_.low <= 0.0 && range_.high >= 0.0;
    if (zero_counts && sum(zero.costs) <= sum(best_.costs)) best_ = zero;
    Located found{0.0,
                  !zero_counts || !as_good(zero.costs, best_.costs),
                  kUnknownError,
                  false,
                  sum(best_.costs),
                  sum(zero.costs)};
    const double low = edge(-1.0);
    const double high = edge(1.0);
    const double half = 0.5 * (high - low);
    const bool inside = low > range_.low && high < range_.high;
    found.told = inside && half <= range_.widest && alone(low, high);
    if (found.told) found.standard_error = std::max(0.5 * half, range_.fine_step);
    if (found.told && found.not_zero) found.at = best_.at;
    return found;
  }

 private:
  Place place(double at) const { return {at, cost_(at)}; }

  void scan() {
    const auto steps = static_cast<int>((range_.high - range_.low) / range_.coarse_step) + 1;
    for (int i = 0; i <= steps; ++i) scanned_.push_back(place(range_.low + (range_.high - range_.low) * i / steps));
  }

  void refine_valleys() {
    std::vector<std::size_t> valleys;
    for (std::size_t i = 0; i < scanned_.size(); ++i) {
      const double here = sum(scanned_[i].costs);
      const bool left = i == 0 || here <= sum(scanned_[i - 1].costs);
      const bool right = i + 1 == scanned_.size() || here < sum(scanned_[i + 1].costs);
      if (left && right) valleys.push_back(i);
    }
    std::sort(valleys.begin(), valleys.end(),
              [&](std::size_t a, std::size_t b) { return sum(scanned_[a].costs) < sum(scanned_[b].costs); });
    valleys.resize(std::min(valleys.size(), kMostValleys));
    best_ = scanned_[valleys.front()];
    for (const std::size_t valley : valleys) {
      const double around = scanned_[valley].at;
      Place bottom =
          golden(std::max(range_.low, around - range_.coarse_step), std::min(range_.high, around + range_.coarse_step));
      if (sum(bottom.costs) < sum(best_.costs)) best_ = bottom;
      scanned_[valley] = std::move(bottom);
    }
  }

  Place golden(double low, double high) const {
    Place a = place(high - kGolden * (high - low));
    Place b = place(low + kGolden * (high - low));
    while (high - low > range_.fine_step) {
      if (sum(a.costs) < sum(b.costs)) {
        high = b.at;
        b = std::move(a);
        a = place(high - kGolden * (high - low));
      } else {
        low = a.at;
        a = std::move(b);
        b = place(low + kGolden * (high - low));
      }
    }
    return sum(a.costs) < sum(b.costs) ? a : b;
  }

  // Where the interval of confidence ends on one side.
  double edge(double direction) const {
    double inside = best_.at;
    double outside = inside;
    for (double step = range_.fine_step;; step *= 2.0) {
      outside = std::clamp(best_.at + direction * step, range_.low, range_.high);
      if (!as_good(cost_(outside), best_.costs)) break;
      inside = outside;
      if (inside == range_.low || inside == range_.high) return inside;
    }
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (inside + outside);
      (as_good(cost_(middle), best_.costs) ? inside : outside) = middle;
    }
    return inside;
  }

  bool alone(double low, double high) const {
    return std::none_of(scanned_.begin(), scanned_.end(), [&](const Place& one) {
      return (one.at < low - range_.coarse_step || one.at > high + range_.coarse_step) &&
             as_good(one.costs, best_.costs);
    });
  }

  const std::function<BlockCosts(double)>& cost_;
  SearchRange range_;
  std::vector<Place> scanned_;
  Place best_;
};

}  // namespace

Located locate(const std::function<BlockCosts(double)>& cost, const SearchRange& range) {
  return Search(cost, range).run();
}

}  // namespace palpate
