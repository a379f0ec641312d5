#include "models/samples/free_air.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace palpate {
namespace {

// The range of positions is divided into these slices; free air covers at least two.
constexpr std::size_t kSlices = 100;
constexpr std::size_t kLeastSlices = 2;
constexpr std::size_t kLeastRows = 10;  // of the stretch
// The medians of the slices stay within this many standard deviations of the noise, or this share of the range of
// forces, because sensors drift and encoders are coarse.
constexpr double kFlatNoises = 3.0;
constexpr double kMedianErrors = 4.0;
constexpr double kFlatShare = 0.003;
constexpr double kFlatFloor_N = 2e-3;
// Over free air the mean stiffness would change the force by more than this multiple of the limit above: materials
// begin ten times softer than they end.
constexpr double kEvidence = 20.0;
// The standard deviation of normal errors over the median of their sizes.
constexpr double kNormalDeviations = 1.4826;
// The acceleration is a difference of velocities over this time.
constexpr double kAccelerationWindow_s = 0.01;
constexpr double kLeastMass_kg = 1e-3;
constexpr double kMassErrors = 5.0;

std::vector<double> accelerations(const std::vector<Sample>& rows) {
  const bool measured =
      std::any_of(rows.begin(), rows.end(), [](const Sample& row) { return row.tool.acceleration_m_per_s2 != 0.0; });
  std::vector<double> result(rows.size(), 0.0);
  std::size_t from = 0;
  std::size_t to = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (measured) {
      result[i] = rows[i].tool.acceleration_m_per_s2;
      continue;
    }
    while (to + 1 < rows.size() && rows[to].tool.time_s < rows[i].tool.time_s + kAccelerationWindow_s) ++to;
    while (rows[from].tool.time_s < rows[i].tool.time_s - kAccelerationWindow_s) ++from;
    const double step_s = rows[to].tool.time_s - rows[from].tool.time_s;
    if (step_s > 0.0) result[i] = (rows[to].motion.velocity_m_per_s - rows[from].motion.velocity_m_per_s) / step_s;
  }
  return result;
}

class AirSearch {
 public:
  AirSearch(const std::vector<Sample>& rows, double force_noise_N)
      : rows_(rows), noise_N_(force_noise_N), acceleration_m_per_s2_(accelerations(rows)), slices_(kSlices) {
    std::tie(low_m_, high_m_) = position_range_m(rows);
    const auto [low, high] = std::minmax_element(
        rows.begin(), rows.end(), [](const Sample& a, const Sample& b) { return a.force_N < b.force_N; });
    range_N_ = high->force_N - low->force_N;
    flat_N_ = std::max({kFlatNoises * force_noise_N, kFlatShare * range_N_, kFlatFloor_N});
    for (std::size_t i = 0; i < rows.size() && high_m_ > low_m_; ++i) {
      const double share = (rows[i].motion.position_m - low_m_) / (high_m_ - low_m_);
      slices_[std::min(kSlices - 1, static_cast<std::size_t>(share * kSlices))].push_back(i);
    }
  }

  FreeAir run() {
    FreeAir air = stretch(0.0);
    // The inertia of the tool may hide the flat slices.
    const double mass_kg = mass();
    if (mass_kg > 0.0) {
      FreeAir without = stretch(mass_kg);
      if (without.found && (!air.found || without.inner_end_m >= air.inner_end_m)) {
        air = without;
        air.tool_mass_kg = mass_kg;
      }
    }
    return air;
  }

 private:
  double force_N(std::size_t i, double mass_kg) const { return rows_[i].force_N - mass_kg * acceleration_m_per_s2_[i]; }

  // Finds the outermost slices whose force is flat during loading.
  FreeAir stretch(double mass_kg) const {
    FreeAir air;
    double lowest_N = HUGE_VAL;
    double highest_N = -HUGE_VAL;
    std::size_t end = 0;
    for (; end < kSlices; ++end) {
      std::vector<double> forces_N;
      for (const std::size_t i : slices_[end]) {
        if (rows_[i].motion.velocity_m_per_s >= 0.0) forces_N.push_back(force_N(i, mass_kg));
      }
      if (forces_N.empty()) continue;
      // The median of a few rows is noisy itself.
      const double middle_N = median_of(forces_N);
      const double margin_N = kMedianErrors * noise_N_ / std::sqrt(static_cast<double>(forces_N.size()));
      lowest_N = std::min(lowest_N, middle_N + margin_N);
      highest_N = std::max(highest_N, middle_N - margin_N);
      if (highest_N - lowest_N > flat_N_) break;
    }
    const double span_m = static_cast<double>(end) / kSlices * (high_m_ - low_m_);
    const double stiffness_N_per_m = range_N_ / std::max(high_m_ - low_m_ - span_m, 1e-9);
    const bool evident = end >= kLeastSlices && end < kSlices && stiffness_N_per_m * span_m > kEvidence * flat_N_;
    if (!evident) return air;
    // If the force begins softly, the inner half may be in the material already.
    air.inner_end_m = low_m_ + 0.5 * span_m;
    std::vector<double> forces_N;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const MotionEstimate& motion = rows_[i].motion;
      if (motion.position_m < air.inner_end_m && motion.velocity_m_per_s >= 0.0)
        forces_N.push_back(force_N(i, mass_kg));
    }
    if (forces_N.size() < kLeastRows) return air;
    air.found = true;
    put_zero(air, forces_N);
    return air;
  }

  // The mean of the forces within three standard deviations of their median, estimated by the median of the deviations:
  // the median of a quantised force is one of its steps, and rows in the material would bias the mean of all.
  void put_zero(FreeAir& air, std::vector<double> forces_N) const {
    const auto third = static_cast<std::ptrdiff_t>(forces_N.size() / 3);
    air.drift_N =
        median_of({forces_N.end() - third, forces_N.end()}) - median_of({forces_N.begin(), forces_N.begin() + third});
    const double middle_N = median_of(forces_N);
    std::vector<double> deviations_N;
    for (const double force_N : forces_N) deviations_N.push_back(std::abs(force_N - middle_N));
    const double limit_N = std::max(flat_N_, 3.0 * kNormalDeviations * median_of(std::move(deviations_N)));
    std::erase_if(forces_N, [&](double force_N) { return std::abs(force_N - middle_N) > limit_N; });
    const auto count = static_cast<double>(forces_N.size());
    double mean_N = 0.0;
    double squares = 0.0;
    for (const double force_N : forces_N) mean_N += (force_N - middle_N) / count;
    for (const double force_N : forces_N) squares += (force_N - middle_N) * (force_N - middle_N);
    air.zero_N = middle_N + mean_N;
    air.zero_error_N = std::sqrt(squares) / count;
  }

  // The mass of the tool, by a regression of the force on the acceleration in the outermost tenth of the slices; 0 if
  // the slope is not significant.
  double mass() const {
    double count = 0.0, a = 0.0, f = 0.0, aa = 0.0, af = 0.0, ff = 0.0;
    for (std::size_t s = 0; s < kSlices / 10; ++s) {
      for (const std::size_t i : slices_[s]) {
        const double x = acceleration_m_per_s2_[i];
        const double y = rows_[i].force_N;
        count += 1.0;
        a += x;
        f += y;
        aa += x * x;
        af += x * y;
        ff += y * y;
      }
    }
    if (count < 3.0 * kLeastRows) return 0.0;
    const double xx = aa - a * a / count;
    const double xy = af - a * f / count;
    const double yy = ff - f * f / count;
    if (!(xx > 0.0)) return 0.0;
    const double mass_kg = xy / xx;
    const double error_kg = std::sqrt(std::max(0.0, yy - mass_kg * xy) / xx / count);
    const bool follows = xy * mass_kg > 0.5 * yy;
    return follows && mass_kg > std::max(kLeastMass_kg, kMassErrors * error_kg) ? mass_kg : 0.0;
  }

  const std::vector<Sample>& rows_;
  double noise_N_;
  std::vector<double> acceleration_m_per_s2_;
  std::vector<std::vector<std::size_t>> slices_;
  double low_m_ = 0.0;
  double high_m_ = 0.0;
  double range_N_ = 0.0;
  double flat_N_ = 0.0;
};

}  // namespace

FreeAir find_free_air(const std::vector<Sample>& rows, double force_noise_N) {
  return rows.size() < kLeastRows ? FreeAir{} : AirSearch(rows, force_noise_N).run();
}

void subtract_inertia(std::vector<Sample>& rows, double mass_kg) {
  const std::vector<double> acceleration_m_per_s2 = accelerations(rows);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].force_N -= mass_kg * acceleration_m_per_s2[i];
}

}  // namespace palpate
