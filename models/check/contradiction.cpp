#include "models/check/contradiction.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate {
namespace {

constexpr int kBins = 60;
constexpr double kApartShare = 0.8;
constexpr double kLeastJnds = 2.0;
constexpr double kExplainedJnds = 1.0;
constexpr double kLeastOverlap = 0.3;  // of the smaller range
constexpr double kTail = 0.05;         // of the forces in a bin, on either side

double quantile_of(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

struct Bin {
  std::vector<double> all_N;
  std::vector<double> inward_N;
  double low_N = 0.0;
  double high_N = 0.0;
  double middle_N = 0.0;  // median, loading
  bool known() const { return !inward_N.empty(); }
};

struct Range {
  double low_m = 0.0;
  double high_m = 0.0;
  double length_m() const { return high_m - low_m; }
};

Range range_of(const Recording& recording) {
  const auto [low, high] = std::ranges::minmax(recording.rows, {}, &RecordingRow::position_m);
  return {low.position_m, high.position_m};
}

// Bins of `width_m` from the outermost position on.
std::vector<Bin> bins_of(const Recording& recording, const Range& range, double width_m) {
  std::vector<Bin> bins(static_cast<std::size_t>(range.length_m() / width_m) + 1);
  double turn_m = range.low_m;
  bool inward = true;
  for (const RecordingRow& row : recording.rows) {
    // A reversal by more than the width of a bin is a turn; less is noise.
    turn_m = inward ? std::max(turn_m, row.position_m) : std::min(turn_m, row.position_m);
    if (std::abs(row.position_m - turn_m) > width_m) {
      inward = !inward;
      turn_m = row.position_m;
    }
    Bin& bin = bins[static_cast<std::size_t>((row.position_m - range.low_m) / width_m)];
    bin.all_N.push_back(row.force_N);
    if (inward) bin.inward_N.push_back(row.force_N);
  }
  for (Bin& bin : bins) {
    if (!bin.known()) continue;
    bin.low_N = quantile_of(bin.all_N, kTail);
    bin.high_N = quantile_of(bin.all_N, 1.0 - kTail);
    bin.middle_N = quantile_of(bin.inward_N, 0.5);
  }
  return bins;
}

struct Comparison {
  double jnds = HUGE_VAL;  // median difference of the bins
  double force_N = 0.0;
  double apart_share = 0.0;
};

// Compares the forces with the bins of `second` moved inwards by `shift`.
Comparison compare(const std::vector<Bin>& first, const std::vector<Bin>& second, int shift, const JndLine& jnd) {
  std::vector<double> jnds;
  std::vector<double> forces_N;
  int apart = 0;
  for (int i = 0; i < static_cast<int>(first.size()); ++i) {
    const int other = i - shift;
    if (other < 0 || other >= static_cast<int>(second.size())) continue;
    const Bin& a = first[static_cast<std::size_t>(i)];
    const Bin& b = second[static_cast<std::size_t>(other)];
    if (!a.known() || !b.known()) continue;
    forces_N.push_back(b.middle_N - a.middle_N);
    jnds.push_back(std::abs(b.middle_N - a.middle_N) / jnd.at(0.5 * (a.middle_N + b.middle_N)));
    if (a.low_N > b.high_N || b.low_N > a.high_N) ++apart;
  }
  const double least = kLeastOverlap * static_cast<double>(std::min(first.size(), second.size()));
  if (static_cast<double>(jnds.size()) < std::max(least, 1.0)) return {};
  const auto count = static_cast<double>(jnds.size());
  return {quantile_of(jnds, 0.5), quantile_of(forces_N, 0.5), apart / count};
}

double inward_speed(const Recording& recording) {
  double path_m = 0.0;
  double time_s = 0.0;
  for (std::size_t i = 1; i < recording.rows.size(); ++i) {
    const double step_m = recording.rows[i].position_m - recording.rows[i - 1].position_m;
    if (!(step_m > 0.0)) continue;
    path_m += step_m;
    time_s += recording.rows[i].time_s - recording.rows[i - 1].time_s;
  }
  return time_s > 0.0 ? path_m / time_s : 0.0;
}

}  // namespace

std::optional<Contradiction> find_contradiction(const Recording& first, const Recording& second, const JndLine& jnd) {
  const Range a = range_of(first);
  const Range b = range_of(second);
  const double overlap_m = std::min(a.high_m, b.high_m) - std::max(a.low_m, b.low_m);
  const double width_m = overlap_m / kBins;
  if (!(overlap_m > kLeastOverlap * std::min(a.length_m(), b.length_m())) || !(width_m > 0.0)) return std::nullopt;
  const std::vector<Bin> one = bins_of(first, a, width_m);
  const std::vector<Bin> other = bins_of(second, b, width_m);
  const int recorded = static_cast<int>(std::lround((b.low_m - a.low_m) / width_m));
  const Comparison as_recorded = compare(one, other, recorded, jnd);
  if (as_recorded.apart_share < kApartShare || !(as_recorded.jnds > kLeastJnds)) return std::nullopt;
  const auto reach = static_cast<int>(std::max(one.size(), other.size()));
  for (int shift = recorded - reach; shift <= recorded + reach; ++shift) {
    if (compare(one, other, shift, jnd).jnds <= kExplainedJnds) return std::nullopt;
  }
  const double speeds[] = {inward_speed(first), inward_speed(second)};
  const double slower = std::min(speeds[0], speeds[1]);
  return Contradiction{as_recorded.force_N, slower > 0.0 ? std::max(speeds[0], speeds[1]) / slower : 1.0};
}

}  // namespace palpate
