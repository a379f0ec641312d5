#include "scenes/material/rig.h"

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"

namespace palpate {
namespace {

constexpr double kGridRate_Hz = 20000.0;
constexpr double kRigStep_s = 1.0 / kGridRate_Hz;
constexpr double kSlowestRate_Hz = 10.0, kFastestRate_Hz = 20000.0;
// 14 hours at 1 kHz; a recording of this size needs 2 GB of memory.
constexpr double kMostRows = 5e7;
constexpr double kEncoderStep_m = 30e-6;
constexpr double kForceNoise_N = 0.005;
constexpr double kAccelerationNoise_m_per_s2 = 0.07;
constexpr double kAccelerationRange_m_per_s2 = 40.0;
constexpr double kBias_m_per_s2 = 0.1;        // standard deviation of the accelerometer's bias
constexpr double kBiasTime_s = 20.0;          // its correlation time
constexpr double kConverterSteps = 4096.0;    // 12 bits
constexpr std::size_t kRowsPerUpdate = 4096;  // between two reports of progress

enum Stream : std::uint64_t { kForceStream = 1, kAccelerationStream, kBiasStream };

// Interpolates between two grid points: the position by a cubic Hermite polynomial, the other values linearly.
RigTruth between(const RigTruth& a, const RigTruth& b, double u) {
  const double rest = 1.0 - u;
  const auto straight = [&](double from, double to) { return from + (to - from) * u; };
  return {a.position_m + (b.position_m - a.position_m) * u * u * (3.0 - 2.0 * u) +
              kRigStep_s * u * rest * (a.velocity_m_per_s * rest - b.velocity_m_per_s * u),
          straight(a.velocity_m_per_s, b.velocity_m_per_s), straight(a.acceleration_m_per_s2, b.acceleration_m_per_s2),
          straight(a.force_N, b.force_N)};
}

// Quantises and clips a value like a 12-bit converter with the range -range .. +range. The + 0.0 here and below turns
// -0 into 0.
double converted(double value, double range) {
  const double step = 2.0 * range / kConverterSteps;
  const double code = std::nearbyint(value / step);
  return std::clamp(code, -0.5 * kConverterSteps, 0.5 * kConverterSteps - 1.0) * step + 0.0;
}

// Quantises to whole encoder steps. The result is rounded to nanometres, which have a short decimal text.
double encoded(double position_m) {
  return std::nearbyint(std::nearbyint(position_m / kEncoderStep_m) * kEncoderStep_m * 1e9) / 1e9 + 0.0;
}

}  // namespace

double Hand::held_depth_m(double force_N) const noexcept {
  double low_m = 0.0, high_m = 0.1;
  for (int i = 0; i < 40; ++i) {
    const double depth_m = 0.5 * (low_m + high_m);
    (block_->half_relaxed_force_N(depth_m) < force_N ? low_m : high_m) = depth_m;
  }
  return low_m;
}

Result<Rig> Rig::create(const RigSettings& settings) {
  const Result<Material> material = find_material(settings.material);
  if (!material) return material.error();
  if (!(settings.rate_Hz >= kSlowestRate_Hz && settings.rate_Hz <= kFastestRate_Hz))
    return Error{"the rate must be 10 to 20000 Hz"};
  const double seconds = settings.seconds == 0.0 ? material->recording_seconds : settings.seconds;
  if (!(seconds > 0.0)) return Error{"the seconds must be a number above 0"};
  const double rows = std::floor(seconds * settings.rate_Hz + 0.5);
  if (rows < static_cast<double>(kRecordingMinimumRows)) return Error{"seconds times rate must give at least 10 rows"};
  if (rows > kMostRows) return Error{"seconds times rate must give at most 50 million rows"};
  return Rig(settings, *material, static_cast<std::size_t>(rows));
}

Rig::Rig(const RigSettings& settings, const Material& material, std::size_t row_count)
    : rate_Hz_(settings.rate_Hz),
      force_range_N_(material.force_range_N),
      hand_(material, HandSettings{.strongest_press_N = material.strongest_press_N}, settings.seed),
      block_(material.make_block()),
      force_noise_(settings.seed, kForceStream),
      acceleration_noise_(settings.seed, kAccelerationStream),
      bias_noise_(settings.seed, kBiasStream),
      row_count_(row_count) {
  block_->reset(hand_.position_m());
  before_ = truth_now();
  advance();
  grid_index_ = 0;
  bias_m_per_s2_ = kBias_m_per_s2 * bias_noise_.normal();
}

RigTruth Rig::truth_now() const noexcept {
  return {hand_.position_m(), hand_.velocity_m_per_s(), hand_.acceleration_m_per_s2(), block_->force_N()};
}

void Rig::advance() noexcept {
  hand_.move(kRigStep_s);
  hand_.feel(block_->step(hand_.position_m(), hand_.velocity_m_per_s(), kRigStep_s), kRigStep_s);
  after_ = truth_now();
  ++grid_index_;
}

RigTruth Rig::truth_at(double grid_time) noexcept {
  const double whole = std::floor(grid_time);
  while (grid_index_ < static_cast<std::uint64_t>(whole)) {
    before_ = after_;
    advance();
  }
  return between(before_, after_, grid_time - whole);
}

bool Rig::next(RecordingRow& row, RigTruth& truth) noexcept {
  if (row_ == row_count_) return false;
  const double index = static_cast<double>(row_++);
  truth = truth_at(index * kGridRate_Hz / rate_Hz_);
  row = {};
  row.time_s = index / rate_Hz_;
  row.position_m = encoded(truth.position_m);
  row.force_N = converted(truth.force_N + kForceNoise_N * force_noise_.normal(), force_range_N_);
  row.acceleration_m_per_s2 = converted(
      truth.acceleration_m_per_s2 + bias_m_per_s2_ + kAccelerationNoise_m_per_s2 * acceleration_noise_.normal(),
      kAccelerationRange_m_per_s2);
  const double share = std::min(1.0, 1.0 / (rate_Hz_ * kBiasTime_s));
  bias_m_per_s2_ += -share * bias_m_per_s2_ + kBias_m_per_s2 * std::sqrt(share * (2.0 - share)) * bias_noise_.normal();
  return true;
}

Result<Recording> record_sensors(const RigSettings& settings, const std::function<bool(double)>& progress) {
  Result<Rig> rig = Rig::create(settings);
  if (!rig) return rig.error();
  Recording recording;
  recording.name = settings.material + "_" + std::to_string(settings.seed);
  recording.columns.acceleration = true;
  recording.rows.reserve(rig->row_count());
  RecordingRow row;
  RigTruth truth;
  while (rig->next(row, truth)) {
    recording.rows.push_back(row);
    const std::size_t done = recording.rows.size();
    const double share = static_cast<double>(done) / static_cast<double>(rig->row_count());
    if (progress && done % kRowsPerUpdate == 0 && !progress(share)) return Error{"interrupted"};
  }
  return recording;
}

std::vector<std::string> describe_recording(const RigSettings& settings, const Material& material,
                                            std::size_t row_count) {
  return {
      "virtual recording by palpate synth: material " + settings.material + ", seed " + std::to_string(settings.seed) +
          ", " + std::to_string(row_count) + " rows at " + shortest(settings.rate_Hz) + " Hz",
      "true relaxation times: " + std::string(material.relaxation_times),
      "encoder step " + shortest(kEncoderStep_m) + " m; force noise " + shortest(kForceNoise_N) +
          " N, 12 bits over +-" + shortest(material.force_range_N) + " N",
      "accelerometer noise " + shortest(kAccelerationNoise_m_per_s2) + " m/s2, bias wandering by " +
          shortest(kBias_m_per_s2) + " m/s2 within " + shortest(kBiasTime_s) + " s, 12 bits over +-" +
          shortest(kAccelerationRange_m_per_s2) + " m/s2",
  };
}

}  // namespace palpate
