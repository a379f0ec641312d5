#include "models/samples/selection.h"

#include <algorithm>
#include <numeric>

#include "engine/base/statistics.h"

namespace palpate {
namespace {

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

// The scores of the folds that have samples in all candidates.
std::vector<double> scores_of(const FoldErrors& errors, std::span<const FoldErrors> candidates) {
  std::vector<double> scores;
  for (std::size_t k = 0; k < errors.counts.size(); ++k) {
    const bool empty = std::ranges::any_of(candidates, [k](const FoldErrors& one) { return one.counts[k] == 0.0; });
    if (empty) continue;
    scores.push_back(std::log(errors.squares[k] / errors.counts[k] + kUnnoticed_jnd * kUnnoticed_jnd));
  }
  return scores;
}

constexpr double kStandardErrors = 2.0;

std::vector<double> differences(const std::vector<double>& one, const std::vector<double>& other) {
  std::vector<double> paired;
  for (std::size_t k = 0; k < one.size(); ++k) paired.push_back(one[k] - other[k]);
  return paired;
}

// Whether the mean of `one` does not exceed that of `best` significantly.
bool is_adequate(const std::vector<double>& one, const std::vector<double>& best) {
  const MeanValue more = mean_of(differences(one, best));
  return more.value <= kStandardErrors * more.standard_error;
}

}  // namespace

std::vector<double> deepest_elsewhere_m(std::span<const int> fold, std::span<const double> depth_m, int folds) {
  std::vector<double> elsewhere_m(static_cast<std::size_t>(folds), 0.0);
  for (std::size_t i = 0; i < fold.size(); ++i) {
    for (int k = 0; k < folds; ++k) {
      double& deepest_m = elsewhere_m[static_cast<std::size_t>(k)];
      if (k != fold[i]) deepest_m = std::max(deepest_m, depth_m[i]);
    }
  }
  return elsewhere_m;
}

double FoldErrors::rms() const {
  const double count = sum_of(counts);
  return count > 0.0 ? std::sqrt(sum_of(squares) / count) : 0.0;
}

double FoldErrors::rms_at_mean_score() const {
  const std::vector<double> scores = scores_of(*this, {this, 1});
  if (scores.empty()) return 0.0;
  const double square = std::exp(sum_of(scores) / static_cast<double>(scores.size()));
  return std::sqrt(std::max(0.0, square - kUnnoticed_jnd * kUnnoticed_jnd));
}

std::size_t best_score(std::span<const FoldErrors> candidates) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < candidates.size(); ++i) {
    const double score = sum_of(scores_of(candidates[i], candidates));
    if (score < sum_of(scores_of(candidates[best], candidates))) best = i;
  }
  return best;
}

std::size_t simplest_adequate(std::span<const FoldErrors> candidates) {
  const std::size_t best = best_score(candidates);
  const std::vector<double> scores = scores_of(candidates[best], candidates);
  for (std::size_t i = 0; i < best; ++i)
    if (is_adequate(scores_of(candidates[i], candidates), scores)) return i;
  return best;
}

namespace {

constexpr double kGolden = 0.6180339887498949;

// Whether `one` is significantly worse than `best` (selection.h). The tenth of the mean block damps blocks with small
// costs, whose relative differences are noise.
bool is_significantly_worse(const BlockCosts& one, const BlockCosts& best) {
  const double least = 0.1 * mean_of(best).value;
  std::vector<double> shares;
  for (std::size_t b = 0; b < one.size(); ++b) {
    const double whole = one[b] + best[b] + least;
    shares.push_back(whole > 0.0 ? (one[b] - best[b]) / whole : 0.0);
  }
  const MeanValue more = mean_of(shares);
  return more.value > kStandardErrors * more.standard_error;
}

struct ScannedOffset {
  double at = 0.0;
  BlockCosts costs;
};

ScannedOffset candidate_at(const CostFunction& cost, double at) {
  ScannedOffset made{at, cost(at)};
  // A cost that is not finite is worse than any other, and sums of it stay finite.
  for (double& one : made.costs) one = std::abs(one) < 1e100 ? one : 1e100;
  return made;
}

// The minimum between `low` and `high` by golden sections.
ScannedOffset golden(const CostFunction& cost, double low, double high, double fine_step) {
  ScannedOffset a = candidate_at(cost, high - kGolden * (high - low));
  ScannedOffset b = candidate_at(cost, low + kGolden * (high - low));
  // In 100 steps an interval shrinks by 1e-21, beyond the digits of any number.
  for (int step = 0; step < 100 && high - low > fine_step; ++step) {
    if (sum_of(a.costs) < sum_of(b.costs)) {
      high = b.at;
      b = std::move(a);
      a = candidate_at(cost, high - kGolden * (high - low));
    } else {
      low = a.at;
      a = std::move(b);
      b = candidate_at(cost, low + kGolden * (high - low));
    }
  }
  return sum_of(a.costs) < sum_of(b.costs) ? a : b;
}

class Search {
 public:
  Search(const CostFunction& cost, const SearchRange& range) : cost_(cost), range_(range) {}

  OffsetEstimate run() {
    if (!(range_.high > range_.low && (range_.high - range_.low) / range_.coarse_step < 1e6)) return {};
    scan();
    const ScannedOffset zero = candidate_at(cost_, 0.0);
    const double effect = range_.systematic_effect;
    const bool any_better = std::ranges::any_of(
        scanned_, [&](const BlockCosts& costs) { return is_significantly_worse(zero.costs, costs); },
        &ScannedOffset::costs);
    if (effect > 0.0 && !any_better) return {};
    refine_valleys();
    look_around();
    OffsetEstimate found;
    found.standard_error = jackknife_error();
    double half = kSignificantErrors * found.standard_error;
    found.identified = best_.at - half > range_.low && best_.at + half < range_.high && half <= range_.widest && alone_;
    if (effect > 0.0) {
      found.identified =
          found.identified && significantly_worse(best_.at - effect) && significantly_worse(best_.at + effect);
      half += effect;
      found.standard_error = std::max(found.standard_error, effect / kSignificantErrors);
    }
    found.not_zero = std::abs(best_.at) > half;
    if (effect > 0.0 && found.not_zero && !is_significantly_worse(zero.costs, best_.costs)) found.identified = false;
    if (!found.identified) found.standard_error = kUnknownError;
    if (found.identified && found.not_zero) found.at = best_.at;
    found.minimum_at = best_.at;
    found.minimum = best_.costs;
    return found;
  }

 private:
  void scan() {
    const auto steps = static_cast<int>((range_.high - range_.low) / range_.coarse_step) + 1;
    for (int i = 0; i <= steps; ++i)
      scanned_.push_back(candidate_at(cost_, range_.low + (range_.high - range_.low) * i / steps));
  }

  void refine_valleys() {
    std::vector<std::size_t> valleys;
    for (std::size_t i = 0; i < scanned_.size(); ++i) {
      const double here = sum_of(scanned_[i].costs);
      const bool left = i == 0 || here <= sum_of(scanned_[i - 1].costs);
      const bool right = i + 1 == scanned_.size() || here < sum_of(scanned_[i + 1].costs);
      if (left && right) valleys.push_back(i);
    }
    std::ranges::sort(valleys, {}, [&](std::size_t i) { return sum_of(scanned_[i].costs); });
    valleys.resize(std::min<std::size_t>(valleys.size(), 4));
    std::vector<ScannedOffset> bottoms;
    for (const std::size_t valley : valleys) {
      const double around = scanned_[valley].at;
      bottoms.push_back(golden(cost_, std::max(range_.low, around - range_.coarse_step),
                               std::min(range_.high, around + range_.coarse_step), range_.fine_step));
      scanned_.push_back(bottoms.back());
    }
    best_ = *std::ranges::min_element(bottoms, {}, [](const ScannedOffset& one) { return sum_of(one.costs); });
    alone_ = std::ranges::none_of(bottoms, [&](const ScannedOffset& one) {
      return std::abs(one.at - best_.at) > 2.0 * range_.coarse_step && !is_significantly_worse(one.costs, best_.costs);
    });
  }

  // Adds offsets at growing distances from the best, for the minima of the jackknife.
  void look_around() {
    for (double step = range_.fine_step; step < range_.coarse_step; step *= 2.0) {
      for (const double at : {best_.at - step, best_.at + step})
        if (at > range_.low && at < range_.high) scanned_.push_back(candidate_at(cost_, at));
    }
    std::ranges::sort(scanned_, {}, &ScannedOffset::at);
  }

  // The minimum of the cost without one block: a parabola through the best offset tried and its neighbours.
  double best_without(std::size_t block) const {
    const auto cost = [&](std::size_t i) { return sum_of(scanned_[i].costs) - scanned_[i].costs[block]; };
    std::size_t best = 0;
    for (std::size_t i = 1; i < scanned_.size(); ++i) best = cost(i) < cost(best) ? i : best;
    const double at = scanned_[best].at;
    if (best == 0 || best + 1 == scanned_.size()) return at;
    const double left = at - scanned_[best - 1].at, right = scanned_[best + 1].at - at;
    if (!(left > 0.0) || !(right > 0.0)) return at;
    const double fall = (cost(best - 1) - cost(best)) / left, climb = (cost(best + 1) - cost(best)) / right;
    const double bend = fall + climb;
    return bend > 0.0 ? at + 0.5 * (fall * right - climb * left) / bend : at;
  }

  bool significantly_worse(double at) const {
    return is_significantly_worse(candidate_at(cost_, at).costs, best_.costs);
  }

  // The jackknife of Quenouille (1956) and Tukey (1958), with one block left out at a time.
  double jackknife_error() const {
    const std::size_t count = best_.costs.size();
    std::vector<double> minima;
    for (std::size_t b = 0; b < count; ++b) minima.push_back(best_without(b));
    // sqrt((n - 1) / n sum (x - mean)^2) is n - 1 times the standard error of the mean of the minima.
    return std::max(static_cast<double>(count - 1) * mean_of(minima).standard_error, range_.fine_step);
  }

  const CostFunction& cost_;
  SearchRange range_;
  std::vector<ScannedOffset> scanned_;
  ScannedOffset best_;
  bool alone_ = true;
};

}  // namespace

OffsetEstimate estimate_offset(const CostFunction& cost, const SearchRange& range) { return Search(cost, range).run(); }

OffsetEstimate unless_force_offset(OffsetEstimate shift, const CostFunction& cost, double most_N) {
  if (!shift.identified || !shift.not_zero || !(most_N > 0.0)) return shift;
  // J, a sum of Huber's losses, has one minimum over the force offset.
  const ScannedOffset best = golden(cost, -most_N, most_N, 1e-3 * most_N);
  const MeanValue more = mean_of(differences(best.costs, shift.minimum));
  if (more.value > more.standard_error) return shift;
  shift.identified = false;
  shift.at = 0.0;
  shift.standard_error = kUnknownError;
  shift.force_offset_N = best.at;
  shift.force_offset_better = is_significantly_worse(shift.minimum, best.costs);
  return shift;
}

}  // namespace palpate
