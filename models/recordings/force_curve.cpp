#include "models/recordings/force_curve.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "models/recordings/profile_search.h"
#include "models/recordings/surface_rows.h"

namespace palpate {
namespace {

constexpr double kBins = 60.0;
constexpr double kMostBins = 6000.0;   // of the larger range
constexpr double kLeastOverlap = 0.3;  // of the smaller number of bins
constexpr double kTail = 0.05;         // of the forces in a bin, on either side
constexpr double kNoticed_jnd = 1.0;
constexpr int kStepsPerBin = 4;

double range_m(const std::vector<ForceAtPosition>& rows) {
  const auto [low, high] = std::ranges::minmax(rows, {}, &ForceAtPosition::position_m);
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

// The number of medians above the JND at 0 N.
double contact_cells(const ForceCurve& curve, const JndLine& jnd) {
  double count = 0.0;
  for (const ForceCurve::Bin& bin : curve.bins()) {
    for (const auto& median_N : bin.median_N) count += median_N && std::abs(*median_N) > jnd.at(0.0) ? 1.0 : 0.0;
  }
  return count;
}

}  // namespace

ForceCurve::ForceCurve(const std::vector<ForceAtPosition>& rows, double bin_m) : bin_m_(bin_m) {
  const double low_m = std::ranges::min(rows, {}, &ForceAtPosition::position_m).position_m;
  first_m_ = low_m + 0.5 * bin_m;
  bins_.resize(static_cast<std::size_t>(range_m(rows) / bin_m) + 1);
  std::vector<std::array<std::vector<double>, 2>> forces_N(bins_.size());
  double turn_m = low_m;
  bool inward = true;
  for (const ForceAtPosition& row : rows) {
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

double common_bin_m(const std::vector<ForceAtPosition>& first, const std::vector<ForceAtPosition>& second) {
  const auto [smaller_m, larger_m] = std::minmax({range_m(first), range_m(second)});
  return std::max(smaller_m / kBins, larger_m / kMostBins);
}

std::optional<CurveDifference> difference(const ForceCurve& first, const ForceCurve& second, double shift_m,
                                          const JndLine& jnd, double force_offset_N) {
  CurveDifference result;
  std::vector<double> jnds;
  std::vector<double> forces_N;
  std::size_t cells = 0;
  std::size_t compared = 0;
  std::size_t apart = 0;
  for (std::size_t i = 0; i < second.bins().size(); ++i) {
    const ForceCurve::Bin& bin = second.bins()[i];
    const double position_m = second.first_m() + static_cast<double>(i) * second.bin_m() - shift_m;
    const std::size_t before = cells;
    for (std::size_t direction = 0; direction < 2; ++direction) {
      const auto first_N = force_N(first, direction, position_m);
      if (!first_N || !bin.median_N[direction]) continue;
      const double second_N = *bin.median_N[direction] - force_offset_N;
      forces_N.push_back(second_N - *first_N);
      const double error = std::abs(second_N - *first_N) / jnd.at(0.5 * (*first_N + second_N));
      result.loss += huber(error, kNoticed_jnd);
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
  result.loss /= static_cast<double>(cells);
  result.contact_cells = static_cast<double>(jnds.size());
  result.median_jnds = median_of(std::move(jnds));
  result.median_N = median_of(std::move(forces_N));
  result.apart_share = static_cast<double>(apart) / static_cast<double>(compared);
  return result;
}

std::optional<double> find_shift_m(const ForceCurve& first, const ForceCurve& second, const JndLine& jnd) {
  const auto as_recorded = difference(first, second, 0.0, jnd);
  if (as_recorded && as_recorded->median_jnds <= kNoticed_jnd) return 0.0;
  const double step_m = first.bin_m() / kStepsPerBin;
  const double apart_m = second.first_m() - first.first_m();
  const int from = -kStepsPerBin * static_cast<int>(first.bins().size());
  const int to = kStepsPerBin * static_cast<int>(second.bins().size());
  // Curves that overlap only in air agree at any shift.
  const double least_cells = kLeastOverlap * std::min(contact_cells(first, jnd), contact_cells(second, jnd));
  std::optional<double> best_m;
  CurveDifference best{std::numeric_limits<double>::infinity()};
  for (int step = from; step <= to; ++step) {
    const double shift_m = apart_m + step * step_m;
    const auto tried = difference(first, second, shift_m, jnd);
    if (!tried || tried->contact_cells < least_cells || !(tried->loss < best.loss)) continue;
    best = *tried;
    best_m = shift_m;
  }
  if (!best_m || best.median_jnds > kNoticed_jnd) return std::nullopt;
  for (const double beside_m : {*best_m - step_m, *best_m + step_m}) {
    if (!difference(first, second, beside_m, jnd)) return std::nullopt;
  }
  if (as_recorded && difference(first, second, 0.0, jnd, as_recorded->median_N)->loss <= best.loss) return std::nullopt;
  return best_m;
}

}  // namespace palpate
