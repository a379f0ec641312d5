#include "models/model/fitted_model.h"

#include <utility>

#include "engine/base/text.h"

namespace palpate {
namespace {

// A press deeper than the deepest recorded one by this share is out of the domain, whatever the radius of the guard,
// which is selected by the gain of the correction away from the data.
constexpr double kDeeper = 0.15;
// A part of the force above this multiple of the largest forces in the file indicates a damaged number: the model would
// jump between 0 and its limit. The parts of a fitted model are far smaller.
constexpr double kMostOfLimit = 100.0;

}  // namespace

double Normalisation::range(Eigen::Index feature) const {
  const double low = lower(feature), high = upper(feature);
  return high - low > 1e-12 * std::max(std::abs(low), std::abs(high)) ? high - low : 0.0;
}

Eigen::VectorXd Normalisation::scale_of(double range_exponent) const {
  Eigen::VectorXd other = scale;
  for (Eigen::Index k = 0; k < other.size(); ++k)
    if (range(k) > 0.0) other(k) = range(k) * std::pow(scale(k) / range(k), 2.0 * (1.0 - range_exponent));
  return other;
}

Status check_forces(const ModelData& data) {
  const double limit_N = kMostOfLimit * (data.largest_force_N + data.correction_limit_N + data.jnd.offset_N);
  const TrendInputs inputs(data.features);
  std::array<double, kMaxFeatures> features{};
  for (Eigen::Index j = 0; j < data.cover.points.cols(); ++j) {
    const auto u = data.cover.points.col(j);
    for (Eigen::Index i = 0; i < u.size(); ++i)
      features[static_cast<std::size_t>(i)] = data.offset(i) + data.scale(i) * u(i);
    const double correction_N = data.correction ? data.correction->evaluate(u.data()) : 0.0;
    for (const auto& [part_N, name] :
         {std::pair{data.trend.at(features.data(), inputs), "trend"}, std::pair{correction_N, "correction"}}) {
      if (std::abs(part_N) <= limit_N) continue;
      return Error{std::string(name) + ": found " + general(part_N, 3) + " N at domain.points[" + std::to_string(j) +
                   "], expected at most " + general(limit_N, 4) +
                   " N, a hundred times the sum of largest_force_N, correction_limit_N and the JND"};
    }
  }
  return {};
}

SensorSpec sensor_with_step(const ModelData& data, double encoder_step_m) {
  const bool theirs = data.sensor && (encoder_step_m == 0.0 || encoder_step_m == data.sensor->encoder_step_m);
  return theirs ? *data.sensor : SensorSpec{encoder_step_m, 0.0};
}

std::string began_words(const ModelData& data, int began) {
  if (began == kBeganAtRest) return "at rest";
  if (began == kBeganAsTold) return "as the end of the recording before";
  const auto index = static_cast<std::size_t>(began);
  const std::vector<std::string>& names = data.provenance.recordings;
  return "as the end of " + (index < names.size() ? names[index] : "training recording " + std::to_string(began + 1));
}

FittedModel::FittedModel(ModelData data)
    : data_(std::move(data)), trend_inputs_(data_.features), guard_(data_.cover), dimension_(data_.features.size()) {
  for (std::size_t i = 0; i < dimension_; ++i) {
    offset_[i] = data_.offset(static_cast<Eigen::Index>(i));
    inverse_scale_[i] = 1.0 / data_.scale(static_cast<Eigen::Index>(i));
  }
  if (trend_inputs_.depth != TrendInputs::kNone) {
    depth_ = trend_inputs_.depth;
    const double lower_m = data_.lower(trend_inputs_.depth), upper_m = data_.upper(trend_inputs_.depth);
    deepest_m_ = upper_m + kDeeper * (upper_m - lower_m);
    if (data_.surface_step_N > 0.0) shallowest_m_ = std::max(lower_m, std::numeric_limits<double>::min());
  }
  trusts_everywhere_ = data_.cover.inner_radius >= kEverywhere;
}

double FittedModel::force(const double* features) const noexcept {
  double force_N = data_.trend.at(features, trend_inputs_);
  if (data_.correction) {
    const std::array<double, kMaxFeatures> u = normalised(features);
    const double correction_N = data_.correction->evaluate(u.data());
    const double trust = trusts_everywhere_ ? 1.0 : guard_.trust(u.data());
    if (trust > 0.0) force_N += trust * std::clamp(correction_N, -data_.correction_limit_N, data_.correction_limit_N);
  }
  // The comparisons are false for NaN, so that the result is always a finite force.
  if (!(force_N > 0.0)) force_N = force_N < 0.0 ? std::max(force_N, data_.lowest_force_N) : 0.0;
  return std::min(force_N, kForceMargin * data_.largest_force_N);
}

void FittedModel::assess(const double* features, ForceEstimate& estimate) const noexcept {
  const bool anywhere = trusts_everywhere_ && !data_.error_bound;
  const double squared_distance = anywhere ? 0.0 : guard_.squared_distance(normalised(features).data());
  estimate.out_of_domain = guard_.trust_at(squared_distance) < 0.5 || features[depth_] > deepest_m_;
  if (!data_.error_bound) return;
  const double beyond = std::sqrt(squared_distance) - data_.cover.inner_radius;
  estimate.predicted_error_N = data_.error_bound->at(estimate.force_N, beyond);
}

}  // namespace palpate
