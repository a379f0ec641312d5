#include "models/check/noise_floor.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr std::size_t kMostSamples = 10000;  // of a recording; of a longer one every n-th is used

}  // namespace

NoiseFloor noise_floor(const std::vector<const PreparedRecording*>& recordings, const JndLine& jnd) {
  std::vector<double> noise_over_jnd;
  double squares_N2 = 0.0;
  for (const PreparedRecording* prepared : recordings) {
    const std::vector<RecordingRow>& rows = prepared->recording.rows;
    const SurfaceEstimate& surface = prepared->surface;
    const double noise_N = prepared->force_noise_N;
    for (std::size_t i = 0; i < rows.size(); i += rows.size() / kMostSamples + 1) {
      if (!(rows[i].position_m > surface.offset_m)) continue;
      noise_over_jnd.push_back(noise_N / jnd.at(rows[i].force_N - surface.force_zero_N));
      squares_N2 += noise_N * noise_N;
    }
  }
  NoiseFloor floor;
  if (!(squares_N2 > 0.0)) return floor;
  const auto count = static_cast<double>(noise_over_jnd.size());
  floor.force_noise_N = std::sqrt(squares_N2 / count);
  const auto share = [&](double jnds) {
    double inside = 0.0;
    for (const double noise : noise_over_jnd) inside += std::erf(jnds / (std::sqrt(2.0) * std::max(noise, 1e-9)));
    return inside / count;
  };
  floor.within_jnd = share(1.0);
  // Bisection. Its upper end suffices: 99 % of a normal distribution are within 2.576 standard deviations.
  double low = 0.0;
  double high = 2.6 * *std::max_element(noise_over_jnd.begin(), noise_over_jnd.end());
  while (high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    (share(middle) < 0.99 ? low : high) = middle;
  }
  floor.p99_error_over_jnd = high;
  return floor;
}

}  // namespace palpate
