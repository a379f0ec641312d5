#include "scenes/evaluation/model_errors.h"

#include <numbers>
#include <numeric>
#include <utility>

#include "engine/base/random_stream.h"
#include "engine/base/statistics.h"
#include "engine/base/text.h"

namespace palpate {
namespace {

constexpr double kOneSided = 0.05;  // probability beyond a one-sided bound; beyond each end of an interval: half

constexpr double kBinWidth_jnd = 2.0;
// Bounds the memory where the JND line is flat. The last bin holds all larger forces.
constexpr std::size_t kMaximumForceBins = 2000;

// The index of the bin of a force, N; forces below 0 (sensor noise) are in bin 0.
std::size_t force_bin(double force_N, const JndLine& jnd) noexcept {
  const double over_offset = std::max(0.0, force_N) / jnd.offset_N;
  const double jnds =
      jnd.weber_fraction > 0.0 ? std::log1p(jnd.weber_fraction * over_offset) / jnd.weber_fraction : over_offset;
  return static_cast<std::size_t>(std::min(jnds / kBinWidth_jnd, static_cast<double>(kMaximumForceBins - 1)));
}

// The smallest force in bin `index`, N.
double force_bin_begin_N(std::size_t index, const JndLine& jnd) noexcept {
  const double jnds = kBinWidth_jnd * static_cast<double>(index);
  return jnd.offset_N * (jnd.weber_fraction > 0.0 ? std::expm1(jnd.weber_fraction * jnds) / jnd.weber_fraction : jnds);
}

// P(|T| <= t) of Student's t distribution. Source: Abramowitz & Stegun (1972), 26.7.3 and 26.7.4.
double central_probability(double t, std::size_t degrees) {
  const double angle = std::atan(t / std::sqrt(static_cast<double>(degrees)));
  const double cosine = std::cos(angle);
  const bool odd = degrees % 2 == 1;
  double term = odd ? cosine : 1.0;
  double sum = degrees > 1 ? term : 0.0;
  for (std::size_t k = odd ? 3 : 2; k + 2 <= degrees; k += 2) {
    term *= cosine * cosine * static_cast<double>(k - 1) / static_cast<double>(k);
    sum += term;
  }
  return odd ? 2.0 / std::numbers::pi * (angle + std::sin(angle) * sum) : std::sin(angle) * sum;
}

// The value that Student's t exceeds with the probability `above`, 0 to 0.5. With more than 200 degrees of freedom it
// is that of 200, which is larger by less than 0.7 %: the sum above stays short.
double student_t(double above, std::size_t degrees) {
  double low = 0.0, high = 1e6;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (central_probability(middle, std::min<std::size_t>(degrees, 200)) < 1.0 - 2.0 * above ? low : high) = middle;
  }
  return high;
}

// Standard error of sum(numerators) / sum(denominators), with one of each per unit; at least two units.
double ratio_standard_error(const std::vector<double>& numerators, const std::vector<double>& denominators) {
  const std::size_t n = numerators.size();
  const double whole = std::accumulate(denominators.begin(), denominators.end(), 0.0);
  const double ratio = std::accumulate(numerators.begin(), numerators.end(), 0.0) / whole;
  double squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) squares += std::pow(numerators[i] - ratio * denominators[i], 2);
  const auto count = static_cast<double>(n);
  return std::sqrt(count / (count - 1.0) * squares) / whole;
}

// The figures of every draw of units. `bounds`: the first sample of each unit in `ratios`, then their number.
Draws resample(const std::vector<float>& ratios, const std::vector<std::size_t>& bounds) {
  Draws draws;
  draws.units = bounds.size() - 1;
  if (draws.units < kLeastUnits) return draws;
  std::vector<std::pair<float, std::size_t>> samples;  // error and unit, in descending order
  std::vector<std::size_t> within(draws.units, 0);
  for (std::size_t unit = 0; unit < draws.units; ++unit) {
    for (std::size_t i = bounds[unit]; i < bounds[unit + 1]; ++i) {
      samples.emplace_back(ratios[i], unit);
      if (ratios[i] <= 1.0F) ++within[unit];
    }
  }
  std::ranges::sort(samples, std::ranges::greater{}, &std::pair<float, std::size_t>::first);
  RandomStream random(1, 0);
  for (std::size_t draw = 0; draw < kResamples; ++draw) {
    std::vector<std::size_t> times(draws.units, 0);
    std::size_t drawn = 0, drawn_within = 0;  // samples
    for (std::size_t k = 0; k < draws.units; ++k) {
      const auto unit = static_cast<std::size_t>(random.index(draws.units));
      ++times[unit];
      drawn += bounds[unit + 1] - bounds[unit];
      drawn_within += within[unit];
    }
    const std::size_t beyond = drawn / 100;  // number of samples that may exceed the 99 % error
    std::size_t count = 0;
    auto one = samples.begin();
    while ((count += times[one->second]) <= beyond) ++one;
    draws.p99.push_back(one->first);
    draws.within.push_back(static_cast<float>(static_cast<double>(drawn_within) / static_cast<double>(drawn)));
  }
  return draws;
}

// The expanded percentile interval of a bootstrap with this number of units.
Interval interval_95(std::vector<float> resampled, std::size_t units) {
  if (resampled.empty()) return {kUnknown, kUnknown};
  const auto n = static_cast<double>(units);
  const double below =
      0.5 * std::erfc(std::sqrt(n / (n - 1.0)) * student_t(0.5 * kOneSided, units - 1) / std::numbers::sqrt2);
  const auto rank = static_cast<std::size_t>(below * static_cast<double>(resampled.size()));
  std::ranges::sort(resampled);
  return {static_cast<double>(resampled[rank]), static_cast<double>(resampled[resampled.size() - 1 - rank])};
}

// The interval of the difference of a figure, draw by draw.
Interval difference_95(const Draws& one, const Draws& other, std::vector<float> Draws::*figure) {
  std::vector<float> differences;
  for (std::size_t i = 0; i < std::min((one.*figure).size(), (other.*figure).size()); ++i)
    differences.push_back((one.*figure)[i] - (other.*figure)[i]);
  return interval_95(std::move(differences), one.units);
}

// Whether `other` is worse than `best` in one figure by a difference that counts. `sign`: 1 where larger is worse.
bool is_worse(const Candidate& other, const Candidate& best, double Candidate::*figure,
              std::vector<float> Draws::*drawn, double sign, double least) {
  if (sign * (other.*figure - best.*figure) < least) return false;
  if (other.strokes == nullptr || best.strokes == nullptr) return true;
  const Interval interval = difference_95(*other.strokes, *best.strokes, drawn);
  return !interval.known() || (sign > 0.0 ? interval.low > 0.0 : interval.high < 0.0);
}

}  // namespace

void Moments::add(double value) {
  const double change = value - mean_;
  mean_ += change / static_cast<double>(++count_);
  squares_ += change * (value - mean_);
  largest_ = std::max(largest_, value);
}

double Moments::deviation() const noexcept {
  return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0.0;
}

void ErrorFigures::add(double model_N, double reference_N, bool out_of_domain, const JndLine& jnd) {
  const double error_N = std::abs(model_N - reference_N);
  const double ratio = jnd.error_over_jnd(model_N, reference_N);
  ++sum_.samples;
  if (ratio <= 1.0) ++within_;
  if (out_of_domain) ++sum_.out_of_domain_samples;
  squares_N2_ += error_N * error_N;
  ratios_ += ratio;
  sum_.max_error_N = std::max(sum_.max_error_N, error_N);
  sum_.max_error_over_jnd = std::max(sum_.max_error_over_jnd, ratio);

  const std::size_t index = force_bin(reference_N, jnd);
  if (sum_.bins.size() <= index) sum_.bins.resize(index + 1);
  ForceBin& bin = sum_.bins[index];
  bin.force_N.add(reference_N);
  bin.error_N.add(error_N);
  bin.over_jnd.add(ratio);
  if (reference_N != 0.0) bin.relative.add(error_N / std::abs(reference_N));
}

ErrorSummary ErrorFigures::summary(const JndLine& jnd) const {
  ErrorSummary summary = sum_;
  summary.rms_error_N = std::sqrt(share(squares_N2_));
  summary.within_jnd = within_jnd();
  for (std::size_t i = 0; i < summary.bins.size(); ++i) {
    ForceBin& bin = summary.bins[i];
    bin.force_from_N = force_bin_begin_N(i, jnd);
    bin.force_to_N = force_bin_begin_N(i + 1, jnd);
    bin.jnd_N = jnd.at(0.5 * (bin.force_from_N + bin.force_to_N));
  }
  return summary;
}

Interval UnitErrors::p99_interval() const { return interval_95(drawn_units.p99, units()); }

double UnitErrors::within_at_least() const {
  if (units() < kLeastUnits) return kUnknown;
  if (units_above_jnd == 0) return std::pow(kOneSided, 1.0 / static_cast<double>(units()));
  return std::max(0.0,
                  within_jnd - student_t(kOneSided, units() - 1) * ratio_standard_error(unit_within, unit_samples));
}

Interval p99_difference(const UnitErrors& one, const UnitErrors& other) {
  return difference_95(one.drawn_strokes, other.drawn_strokes, &Draws::p99);
}

void ModelErrors::add(double model_N, double measured_N, bool out_of_domain, double bound_N) {
  if (strokes_.empty()) begin_stroke();
  figures_.add(model_N, measured_N, out_of_domain, jnd_);
  ratios_.push_back(static_cast<float>(jnd_.error_over_jnd(model_N, measured_N)));
  if (std::isnan(bound_N)) return;
  bounds_N_.push_back(static_cast<float>(bound_N));
  bounds_over_jnd_.push_back(static_cast<float>(bound_N / jnd_.at(measured_N)));
  if (std::abs(model_N - measured_N) <= bound_N) ++covered_;
  largest_force_N_ = std::max(largest_force_N_, std::abs(measured_N));
}

ErrorSummary ModelErrors::summary() const {
  ErrorSummary summary = figures_.summary(jnd_);
  summary.p99_error_over_jnd = static_cast<double>(quantile_of(ratios_, 99));
  // Outside its surface a model returns 0 N with certainty, whether it has a bound or not.
  if (std::ranges::none_of(bounds_N_, [](float bound_N) { return bound_N > 0.0F; })) return summary;
  const auto median_N = static_cast<double>(median_of(bounds_N_));
  summary.bound = {static_cast<double>(covered_) / static_cast<double>(bounds_N_.size()), median_N,
                   median_N <= largest_force_N_ ? static_cast<double>(median_of(bounds_over_jnd_)) : kUnknown};
  return summary;
}

UnitErrors ModelErrors::unit_errors() const {
  UnitErrors unit_errors;
  static_cast<ErrorSummary&>(unit_errors) = summary();
  // The first sample of each unit, and their number. A recording without contact has no samples, as has a stroke that
  // ended before the counted time.
  const auto bounds_of = [&](std::vector<std::size_t> bounds) {
    bounds.push_back(ratios_.size());
    bounds.erase(std::unique(bounds.begin(), bounds.end()), bounds.end());
    return bounds;
  };
  std::vector<std::size_t> bounds = bounds_of(strokes_);
  unit_errors.drawn_strokes = resample(ratios_, bounds);
  const std::vector<std::size_t> recordings = bounds_of(recordings_);
  unit_errors.units_are_recordings = recordings.size() > 2;
  if (unit_errors.units_are_recordings) bounds = recordings;
  for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
    const auto begin = ratios_.begin() + static_cast<std::ptrdiff_t>(bounds[i]);
    const auto end = ratios_.begin() + static_cast<std::ptrdiff_t>(bounds[i + 1]);
    const auto within = std::count_if(begin, end, [](float ratio) { return ratio <= 1.0F; });
    unit_errors.unit_samples.push_back(static_cast<double>(end - begin));
    unit_errors.unit_within.push_back(static_cast<double>(within));
    unit_errors.units_above_jnd += within < end - begin ? 1 : 0;
  }
  unit_errors.drawn_units = unit_errors.units_are_recordings ? resample(ratios_, bounds) : unit_errors.drawn_strokes;
  return unit_errors;
}

Ranking rank(const std::vector<Candidate>& candidates, double budget_ns) {
  const bool all = std::ranges::none_of(candidates, [&](const Candidate& one) { return one.tick_ns <= budget_ns; });
  std::vector<std::size_t> eligible, many;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!all && candidates[i].tick_ns > budget_ns) continue;
    eligible.push_back(i);
    if (candidates[i].within_jnd >= kManyWithin) many.push_back(i);
  }
  const auto within = [&](std::size_t i) { return candidates[i].within_jnd; };
  const auto p99 = [&](std::size_t i) { return candidates[i].p99_error_over_jnd; };
  const auto tick_ns = [&](std::size_t i) { return candidates[i].tick_ns; };
  const bool several = many.size() > 1;
  Ranking ranking;
  ranking.best = several ? *std::ranges::min_element(many, {}, p99) : *std::ranges::max_element(eligible, {}, within);
  const Candidate& best = candidates[ranking.best];
  ranking.as_good.resize(candidates.size());
  std::vector<std::size_t> as_good, below;
  for (const std::size_t i : eligible) {
    const Candidate& one = candidates[i];
    const bool by_share = !several || one.within_jnd < kManyWithin;
    const bool worse =
        (by_share && is_worse(one, best, &Candidate::within_jnd, &Draws::within, -1.0, kLeastShare)) ||
        (several && is_worse(one, best, &Candidate::p99_error_over_jnd, &Draws::p99, 1.0, kLeastDifference_jnd));
    ranking.as_good[i] = !worse;
    if (!worse) as_good.push_back(i);
    if (one.p99_error_over_jnd <= 1.0) below.push_back(i);
  }
  ranking.recommended = *std::ranges::min_element(as_good, {}, tick_ns);
  if (!below.empty()) ranking.fastest_below_jnd = *std::ranges::min_element(below, {}, tick_ns);
  return ranking;
}

std::string share_text(double share) {
  return share >= 1.0 ? "100 %" : fixed(std::floor(1000.0 * share + 1e-9) / 10.0, 1) + " %";
}

std::string tick_text(double tick_ns) {
  const double tick_us = 1e-3 * tick_ns;
  return (tick_us < 99.5 ? general(tick_us, 2) : fixed(tick_us, 0)) + " us";
}

std::string recommendation(const std::string& name, const Candidate& of) {
  return (of.within_jnd >= kGoodShare ? "Use " : "No model is good enough; the rule takes ") + name + ": " +
         share_text(of.within_jnd) + " of the test is within one JND, a tick takes " + tick_text(of.tick_ns) + ".";
}

}  // namespace palpate
