#include "models/model/fitted_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "engine/base/text.h"
#include "engine/recording/recording_rules.h"

namespace palpate {
namespace {

// A press deeper than the deepest recorded one by this share is out of the domain, whatever the radius of the guard,
// which is selected by the gain of the correction away from the data.
constexpr double kDeeper = 0.15;
// Relaxation times that grow by more than exp(20), or 5e8, with the depth indicate a damaged file.
constexpr double kMostSlowing = 20.0;

Error wrong(const std::string& field, const std::string& found, const std::string& expected) {
  return {field + ": found " + found + ", expected " + expected};
}

// Keeps the first fault.
class Check {
 public:
  void that(bool good, const std::string& field, const std::string& found, const std::string& expected) {
    if (!good && status_) status_ = wrong(field, found, expected);
  }
  void positive(const std::string& field, double value) {
    that(value > 0.0 && std::isfinite(value), field, std::to_string(value), "a positive number");
  }
  void not_negative(const std::string& field, double value) {
    that(value >= 0.0 && std::isfinite(value), field, std::to_string(value), "0 or more");
  }
  // Recordings have no larger forces (engine/recording/recording_rules.h).
  void recorded_force(const std::string& field, double value_N) {
    that(std::abs(value_N) <= kMaximumForce_N, field, general(value_N, 4) + " N", "at most 1e6 N");
  }
  void finite(const std::string& field, bool good) { that(good, field, "a non-finite number", "finite numbers"); }
  void per_feature(const std::string& field, const Eigen::VectorXd& values, Eigen::Index count) {
    that(values.size() == count, field, std::to_string(values.size()) + " values",
         std::to_string(count) + ", one per feature");
    finite(field, values.allFinite());
  }
  void drive(const std::string& field, const DriveCurve& curve) {
    // The curve of a branch with a short relaxation time may be large, but it is a force.
    const auto is_force = [](double value_N) { return std::abs(value_N) <= 1e9; };
    positive(field + ".reference_depth_m", curve.reference_depth_m);
    that(std::all_of(curve.coefficient_N.begin(), curve.coefficient_N.end(), is_force) &&
             std::all_of(curve.knot_N.begin(), curve.knot_N.end(), is_force),
         field, "a number beyond any force", "at most 1e9 N");
  }
  const Status& status() const { return status_; }

 private:
  Status status_;
};

void check_feature(Check& check, const FeatureSpec& spec) {
  if (has_time(spec.kind)) check.positive("features.relaxation_time_s", spec.relaxation_time_s);
  check.drive("features.drive", spec.drive);
  check.that(std::abs(spec.slowing) <= kMostSlowing, "features.slowing", std::to_string(spec.slowing),
             "a number from -20 to 20");
  check.that(std::isfinite(spec.surface_position_m), "features.surface_position_m",
             std::to_string(spec.surface_position_m), "a finite number");
  if (!has_parts(spec.kind)) return;
  const bool fits = spec.part_count >= 1 && spec.part_count <= kMaxFeatureParts;
  check.that(fits, "features.parts", std::to_string(spec.part_count) + " parts", "1 to 8");
  for (std::size_t p = 0; fits && p < spec.part_count; ++p) {
    const FeaturePart& part = spec.parts[p];
    if (is_bristle(spec.kind)) check.positive("features.parts.threshold_m", part.threshold_m);
    if (spec.kind != FeatureKind::stops) check.positive("features.parts.relaxation_time_s", part.relaxation_time_s);
    check.drive("features.parts.drive", part.drive);
  }
}

void check_trend(Check& check, const Trend& trend) {
  const auto finite = [](const auto& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  };
  check.positive("trend.reference_depth_m", trend.reference_depth_m);
  check.finite("trend",
               finite(trend.elastic.pieces_N) && finite(trend.viscosity_Ns_per_m) && finite(trend.thinning_Ns_per_m));
  check.positive("trend.thinning_velocity_m_per_s", trend.thinning_velocity_m_per_s);
  check.not_negative("trend.velocity_limit_m_per_s", trend.velocity_limit_m_per_s);
}

void check_cover(Check& check, const DomainCover& cover, Eigen::Index dimension) {
  check.that(cover.points.rows() == dimension && cover.points.cols() >= 1, "domain.points",
             std::to_string(cover.points.cols()) + " points of " + std::to_string(cover.points.rows()) + " values",
             "at least one point of " + std::to_string(dimension) + " values");
  check.finite("domain.points", cover.points.allFinite());
  check.that(cover.inner_radius >= 0.0 && cover.outer_radius > cover.inner_radius && std::isfinite(cover.outer_radius),
             "domain radii", std::to_string(cover.inner_radius) + " and " + std::to_string(cover.outer_radius),
             "0 <= inner < outer");
}

// A part of the force above this multiple of the largest forces in the file indicates a damaged number: the model would
// jump between 0 and its limit. The parts of a fitted model are far smaller.
constexpr double kMostOfLimit = 100.0;

// Checks the forces at the points of the cover.
Status validate_forces(const ModelData& data) {
  const double limit_N = kMostOfLimit * (data.largest_force_N + data.correction_limit_N + data.jnd.offset_N);
  const TrendInputs inputs(data.features);
  std::array<double, kMaxFeatures> features{};
  for (Eigen::Index j = 0; j < data.cover.points.cols(); ++j) {
    const auto u = data.cover.points.col(j);
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      features[static_cast<std::size_t>(i)] = data.offset(i) + data.scale(i) * u(i);
    }
    const double correction_N = data.correction->is_none() ? 0.0 : data.correction->evaluate(u.data());
    for (const auto& [part_N, name] :
         {std::pair{data.trend.at(features.data(), inputs), "trend"}, std::pair{correction_N, "correction"}}) {
      if (std::abs(part_N) <= limit_N) continue;
      char text[160];
      std::snprintf(text, sizeof text, "%.3g N at domain.points[%d]", part_N, static_cast<int>(j));
      const std::string found = text;
      std::snprintf(text, sizeof text, "at most %.4g N, a hundred times the sum of largest_force_N, %s", limit_N,
                    "correction_limit_N and the JND");
      return wrong(name, found, text);
    }
  }
  return {};
}

}  // namespace

Status validate_model(const ModelData& data) {
  const auto n = static_cast<Eigen::Index>(data.features.size());
  Check check;
  check.that(n >= 1 && n <= static_cast<Eigen::Index>(kMaxFeatures), "features", std::to_string(n) + " features",
             "1 to 8");
  for (const FeatureSpec& spec : data.features) check_feature(check, spec);
  check.per_feature("normalisation.offset", data.offset, n);
  check.per_feature("normalisation.scale", data.scale, n);
  check.per_feature("domain.lower", data.lower, n);
  check.per_feature("domain.upper", data.upper, n);
  check.that((data.scale.array() > 0.0).all(), "normalisation.scale", "0 or less", "positive numbers");
  check_trend(check, data.trend);
  check_cover(check, data.cover, n);
  if (const auto& bound = data.error_bound) {
    for (const double value : {bound->floor_N, bound->per_force, bound->per_distance_N})
      check.not_negative("error_bound", value);
  }
  if (const auto& sensor = data.sensor) {
    for (const double value : {sensor->encoder_step_m, sensor->position_noise_m}) check.not_negative("sensor", value);
  }
  check.not_negative("correction_limit_N", data.correction_limit_N);
  check.not_negative("largest_force_N", data.largest_force_N);
  for (const auto& [name, value_N] :
       {std::pair{"correction_limit_N", data.correction_limit_N}, std::pair{"largest_force_N", data.largest_force_N},
        std::pair{"lowest_force_N", data.lowest_force_N}})
    check.recorded_force(name, value_N);
  check.not_negative("jnd.offset_N", data.jnd.offset_N);
  check.not_negative("jnd.weber_fraction", data.jnd.weber_fraction);
  check.that(data.lowest_force_N <= 0.0 && std::isfinite(data.lowest_force_N), "lowest_force_N",
             std::to_string(data.lowest_force_N), "0 or less");
  check.that(data.correction != nullptr, "model", "no correction", "centres, a grid, or the trend alone");
  if (!check.status()) return check.status();
  if (Status status = data.correction->validate(static_cast<int>(n)); !status) return status;
  return validate_forces(data);
}

PositionSensor sensor_with_step(const ModelData& data, double encoder_step_m) {
  const bool theirs = data.sensor && (encoder_step_m == 0.0 || encoder_step_m == data.sensor->encoder_step_m);
  return theirs ? *data.sensor : PositionSensor{encoder_step_m, 0.0};
}

double deepest_in_domain_m(const ModelData& data, std::size_t& feature) {
  double deepest_m = std::numeric_limits<double>::infinity();
  feature = 0;
  for (std::size_t i = 0; i < data.features.size(); ++i) {
    if (data.features[i].kind != FeatureKind::depth) continue;
    const auto k = static_cast<Eigen::Index>(i);
    feature = i;
    deepest_m = data.upper(k) + kDeeper * (data.upper(k) - data.lower(k));
  }
  return deepest_m;
}

FittedModel::FittedModel(ModelData data)
    : data_(std::move(data)), trend_inputs_(data_.features), guard_(data_.cover), dimension_(data_.features.size()) {
  if (!data_.correction->is_none()) correction_ = data_.correction.get();
  for (std::size_t i = 0; i < dimension_; ++i) {
    offset_[i] = data_.offset(static_cast<Eigen::Index>(i));
    inverse_scale_[i] = 1.0 / data_.scale(static_cast<Eigen::Index>(i));
  }
  deepest_m_ = deepest_in_domain_m(data_, depth_);
}

int FittedModel::centre_count() const noexcept { return data_.correction->size(); }

ForceEstimate FittedModel::evaluate(const double* features) const noexcept {
  std::array<double, kMaxFeatures> u{};
  for (std::size_t i = 0; i < dimension_; ++i) u[i] = (features[i] - offset_[i]) * inverse_scale_[i];
  // This order lets the processor overlap the work: the search for the leaf of the guard, a chain of dependent steps,
  // with the correction, and the distances in the leaf with the last square roots of the correction. No other order is
  // faster, some are slower by up to 26 ns (Zen 4).
  const double trend_N = data_.trend.at(features, trend_inputs_);
  const float* leaf = guard_.leaf(u.data());
  double correction_N = correction_ != nullptr ? correction_->evaluate(u.data()) : 0.0;
  const double squared_distance = guard_.squared_distance(u.data(), leaf);
  const double trust = guard_.trust_at(squared_distance);
  double force_N = trend_N;
  if (trust > 0.0 && correction_ != nullptr) {
    if (!data_.corrects_trend) correction_N -= trend_N;
    force_N += trust * std::clamp(correction_N, -data_.correction_limit_N, data_.correction_limit_N);
  }
  // The comparisons are false for NaN, so that the result is always a finite force.
  const double largest_N = kForceMargin * data_.largest_force_N;
  if (!(force_N > 0.0)) force_N = force_N < 0.0 ? std::max(force_N, data_.lowest_force_N) : 0.0;
  ForceEstimate estimate{std::min(force_N, largest_N), trust < 0.5 || features[depth_] > deepest_m_};
  if (data_.error_bound) {
    const double beyond = std::sqrt(squared_distance) - data_.cover.inner_radius;
    estimate.predicted_error_N = data_.error_bound->at(std::abs(estimate.force_N), beyond);
  }
  return estimate;
}

}  // namespace palpate
