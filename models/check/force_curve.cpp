#include "models/check/force_curve.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "models/samples/profile_search.h"
#include "models/samples/sample.h"

namespace palpate {
namespace {

constexpr double kBins = 60.0;
constexpr double kMostBins = 6000.0;   // of the larger range
constexpr double kLeastOverlap = 0.3;  // of the smaller number of bins
constexpr double kTail = 0.05;         // of the forces in a bin, on either side

double range_m(const std::vector<RecordingRow>& rows) {
  const auto [low, high] = std::ranges::minmax(rows, {}, &RecordingRow::position_m);
  return high.position_m - low.position_m;
}

// The force of the curve at a position; none outside of it or next to an empty bin.
std::optional<double> force_N(const ForceCurve& curve, std::size_t direction, double position_m) {
  const double at = (position_m - curve.first_m()) / curve.bin_m();
  if (!(at >= 0.0) || at + 1.0 >= static_cast<double>(curve.bins().size())) return std::nullopt;
  const auto bin = static_cast<std::size_t>(at);
  const auto& before_N = curve.bins()[bin].median_N[direction];
  const auto& after_N = curve.bins()[bin + 1].median_N[direction];
  if (!before_N || !after_N) return std::nullopt;
  return *before_N + (at - static_cast<double>(bin)) * (*after_N - *before_N);
}

}  // namespace

ForceCurve::ForceCurve(const std::vector<RecordingRow>& rows, double bin_m) : bin_m_(bin_m) {
  const double low_m = std::ranges::min(rows, {}, &RecordingRow::position_m).position_m;
  first_m_ = low_m + 0.5 * bin_m;
  bins_.resize(static_cast<std::size_t>(range_m(rows) / bin_m) + 1);
  std::vector<std::array<std::vector<double>, 2>> forces_N(bins_.size());
  double turn_m = low_m;
  bool inward = true;
  for (const RecordingRow& row : rows) {
    turn_m = inward ? std::max(turn_m, row.position_m) : std::min(turn_m, row.position_m);
    if (std::abs(row.position_m - turn_m) > bin_m) {
      inward = !inward;
      turn_m = row.position_m;
    }
    forces_N[static_cast<std::size_t>((row.position_m - low_m) / bin_m)][inward ? 0 : 1].push_back(row.force_N);
  }
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    std::vector<double> all_N;
    for (std::size_t direction = 0; direction < 2; ++direction) {
      const std::vector<double>& some_N = forces_N[i][direction];
      all_N.insert(all_N.end(), some_N.begin(), some_N.end());
      if (!some_N.empty()) bins_[i].median_N[direction] = median_of(some_N);
    }
    if (all_N.empty()) continue;
    std::ranges::sort(all_N);
    const double last = static_cast<double>(all_N.size() - 1);
    bins_[i].low_N = all_N[static_cast<std::size_t>(kTail * last)];
    bins_[i].high_N = all_N[static_cast<std::size_t>((1.0 - kTail) * last)];
  }
}

double common_bin_m(const std::vector<RecordingRow>& first, const std::vector<RecordingRow>& second) {
  const auto [smaller_m, larger_m] = std::minmax({range_m(first), range_m(second)});
  return std::max(smaller_m / kBins, larger_m / kMostBins);
}

std::optional<CurveDifference> difference(const ForceCurve& first, const ForceCurve& second, double shift_m,
                                          const JndLine& jnd) {
  CurveDifference result;
  std::vector<double> jnds, forces_N;
  std::size_t cells = 0, compared = 0, apart = 0;
  for (std::size_t i = 0; i < second.bins().size(); ++i) {
    const ForceCurve::Bin& bin = second.bins()[i];
    const double position_m = second.first_m() + static_cast<double>(i) * second.bin_m() - shift_m;
    const std::size_t before = cells;
    for (std::size_t direction = 0; direction < 2; ++direction) {
      const auto first_N = force_N(first, direction, position_m);
      if (!first_N || !bin.median_N[direction]) continue;
      const double second_N = *bin.median_N[direction];
      forces_N.push_back(second_N - *first_N);
      const double error = std::abs(second_N - *first_N) / jnd.at(0.5 * (*first_N + second_N));
      ++cells;
      if (std::max(std::abs(*first_N), std::abs(second_N)) > jnd.at(0.0)) jnds.push_back(error);
    }
    if (cells == before) continue;
    ++compared;
    const ForceCurve::Bin& other =
        first.bins()[static_cast<std::size_t>((position_m - first.first_m()) / first.bin_m() + 0.5)];
    if (bin.low_N > other.high_N || other.low_N > bin.high_N) ++apart;
  }
  const auto fewer = static_cast<double>(std::min(first.bins().size(), second.bins().size()));
  if (static_cast<double>(compared) < std::max(1.0, kLeastOverlap * fewer)) return std::nullopt;
  result.median_jnds = median_of(std::move(jnds));
  result.median_N = median_of(std::move(forces_N));
  result.apart_share = static_cast<double>(apart) / static_cast<double>(compared);
  return result;
}

}  // namespace palpate
