#include "models/samples/cross_validation.h"

#include <algorithm>
#include <numeric>

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

// Whether the mean of `one` does not exceed that of `best` significantly.
bool is_adequate(const std::vector<double>& one, const std::vector<double>& best) {
  const auto count = static_cast<double>(one.size());
  if (one.empty()) return true;
  const double mean = (sum_of(one) - sum_of(best)) / count;
  double squares = 0.0;
  for (std::size_t k = 0; k < one.size(); ++k) squares += std::pow(one[k] - best[k] - mean, 2);
  return mean <= kStandardErrors * (count > 1.0 ? std::sqrt(squares / (count - 1.0) / count) : 0.0);
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

}  // namespace palpate
