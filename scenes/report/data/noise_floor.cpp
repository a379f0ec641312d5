#include "scenes/report/data/noise_floor.h"

#include <algorithm>
#include <cmath>

#include "engine/tick/sensor_identification.h"

namespace palpate {
namespace {

constexpr double kLowest = 1e-6;  // noise over JND
constexpr double kPerDecade = 200.0;
constexpr std::size_t kBins = 2000;  // ten decades

double ratio_of(std::size_t bin) { return kLowest * std::pow(10.0, (static_cast<double>(bin) + 0.5) / kPerDecade); }

}  // namespace

void NoiseFloorFinder::add(const Recording& recording) {
  histogram_.resize(kBins, 0);
  const std::size_t count = std::min(recording.rows.size(), kSensorIdentificationRows);
  const double noise_N = identify_force_noise_N(recording.rows.data(), count);
  for (const RecordingRow& row : recording.rows) {
    if (row.position_m <= 0.0) continue;
    const double ratio = std::max(noise_N / jnd_.at(row.force_N), kLowest);
    const auto bin = static_cast<std::size_t>(kPerDecade * std::log10(ratio / kLowest));
    ++histogram_[std::min(bin, kBins - 1)];
    ++samples_;
    squares_ += noise_N * noise_N;
  }
}

NoiseFloor NoiseFloorFinder::result() const {
  NoiseFloor floor;
  if (samples_ == 0) return floor;
  floor.force_noise_N = std::sqrt(squares_ / static_cast<double>(samples_));
  floor.rms_error_N = floor.force_noise_N;
  const auto share = [&](double jnds) {
    double inside = 0.0;
    for (std::size_t i = 0; i < kBins; ++i) {
      if (histogram_[i] == 0) continue;
      inside += static_cast<double>(histogram_[i]) * std::erf(jnds / (std::sqrt(2.0) * ratio_of(i)));
    }
    return inside / static_cast<double>(samples_);
  };
  floor.within_jnd = share(1.0);
  double low = 1e-7;
  double high = 1e6;
  while (high / low > 1.0001) {
    const double middle = std::sqrt(low * high);
    (share(middle) < 0.99 ? low : high) = middle;
  }
  floor.p99_error_over_jnd = floor.force_noise_N > 0.0 ? high : 0.0;
  return floor;
}

}  // namespace palpate
