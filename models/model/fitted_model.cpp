#include "models/model/fitted_model.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace palpate {
namespace {

// The guard's radius is chosen by what the correction is worth beyond the data; a press
// deeper than the deepest recorded one by this share is out of the domain in any case.
constexpr double kDeeper = 0.15;
// Times that grow a hundred million times with the depth are a damaged file.
constexpr double kMostSlowing = 20.0;

Error wrong(const std::string& field, const std::string& found, const std::string& expected) {
  return {field + ": found " + found + ", expected " + expected};
}

Status validate_vector(const Eigen::VectorXd& values, const std::string& field, Eigen::Index expected) {
  if (values.size() != expected) {
    return wrong(field, std::to_string(values.size()) + " values", std::to_string(expected) + ", one per feature");
  }
  if (!values.allFinite()) return wrong(field, "a non-finite number", "finite numbers");
  return {};
}

Status validate_positive(const std::string& field, double value) {
  if (value > 0.0 && std::isfinite(value)) return {};
  return wrong(field, std::to_string(value), "a positive number");
}

Status validate_not_negative(const std::string& field, double value) {
  if (value >= 0.0 && std::isfinite(value)) return {};
  return wrong(field, std::to_string(value), "0 or more");
}

// Of a branch that relaxes at once the curve may be large, but it is a force.
bool is_force(double value_N) { return std::abs(value_N) <= 1e9; }

Status validate_drive(const std::string& field, const DriveCurve& drive) {
  if (Status status = validate_positive(field + ".reference_depth_m", drive.reference_depth_m); !status) return status;
  if (std::all_of(drive.coefficient_N.begin(), drive.coefficient_N.end(), is_force) &&
      std::all_of(drive.knot_N.begin(), drive.knot_N.end(), is_force)) {
    return {};
  }
  return wrong(field, "a number that is no force", "at most 1e9 N");
}

Status validate_features(const std::vector<FeatureSpec>& features) {
  if (features.empty() || features.size() > kMaxFeatures) {
    return wrong("features", std::to_string(features.size()) + " features", "1 to 8");
  }
  for (const FeatureSpec& spec : features) {
    if (has_time(spec.kind)) {
      if (Status status = validate_positive("features.relaxation_time_s", spec.relaxation_time_s); !status)
        return status;
    }
    if (Status status = validate_drive("features.drive", spec.drive); !status) return status;
    if (!(std::abs(spec.slowing) <= kMostSlowing)) {
      return wrong("features.slowing", std::to_string(spec.slowing), "a number from -20 to 20");
    }
    if (!std::isfinite(spec.surface_position_m)) {
      return wrong("features.surface_position_m", std::to_string(spec.surface_position_m), "a finite number");
    }
    if (!has_parts(spec.kind)) continue;
    if (spec.part_count < 1 || spec.part_count > kMaxFeatureParts) {
      return wrong("features.parts", std::to_string(spec.part_count) + " parts", "1 to 8");
    }
    for (std::size_t p = 0; p < spec.part_count; ++p) {
      const FeaturePart& part = spec.parts[p];
      if (is_bristle(spec.kind)) {
        if (Status status = validate_positive("features.parts.threshold_m", part.threshold_m); !status) return status;
      }
      if (spec.kind != FeatureKind::stops) {
        const Status status = validate_positive("features.parts.relaxation_time_s", part.relaxation_time_s);
        if (!status) return status;
      }
      if (Status status = validate_drive("features.parts.drive", spec.parts[p].drive); !status) return status;
    }
  }
  return {};
}

Status validate_trend(const Trend& trend) {
  if (Status status = validate_positive("trend.reference_depth_m", trend.reference_depth_m); !status) return status;
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(trend.elastic_N.begin(), trend.elastic_N.end(), finite) ||
      !std::all_of(trend.elastic_knot_N.begin(), trend.elastic_knot_N.end(), finite) ||
      !std::all_of(trend.viscosity_Ns_per_m.begin(), trend.viscosity_Ns_per_m.end(), finite) ||
      !std::all_of(trend.thinning_Ns_per_m.begin(), trend.thinning_Ns_per_m.end(), finite)) {
    return wrong("trend", "a non-finite number", "finite numbers");
  }
  if (Status status = validate_positive("trend.thinning_velocity_m_per_s", trend.thinning_velocity_m_per_s); !status)
    return status;
  return validate_not_negative("trend.velocity_limit_m_per_s", trend.velocity_limit_m_per_s);
}

Status validate_cover(const DomainCover& cover, Eigen::Index dimension) {
  if (cover.points.rows() != dimension || cover.points.cols() < 1) {
    return wrong("domain.points",
                 std::to_string(cover.points.cols()) + " points of " + std::to_string(cover.points.rows()) + " values",
                 "at least one point of " + std::to_string(dimension) + " values");
  }
  if (!cover.points.allFinite()) return wrong("domain.points", "a non-finite number", "finite numbers");
  if (!(cover.inner_radius >= 0.0) || !(cover.outer_radius > cover.inner_radius) ||
      !std::isfinite(cover.outer_radius)) {
    return wrong("domain radii", std::to_string(cover.inner_radius) + " and " + std::to_string(cover.outer_radius),
                 "0 <= inner < outer");
  }
  return {};
}

// A part of the force that is beyond this multiple of the largest forces that the file names
// is a damaged number: the model would jump between 0 and its limit. The parts of a fitted
// model cancel one another to within far less.
constexpr double kMostOfLimit = 100.0;

// At the recorded samples that the domain is made of.
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
  if (Status status = validate_features(data.features); !status) return status;
  const auto n = static_cast<Eigen::Index>(data.features.size());
  for (const auto& [values, field] :
       {std::pair{&data.offset, "normalisation.offset"}, std::pair{&data.scale, "normalisation.scale"},
        std::pair{&data.lower, "domain.lower"}, std::pair{&data.upper, "domain.upper"}}) {
    if (Status status = validate_vector(*values, field, n); !status) return status;
  }
  if (!(data.scale.array() > 0.0).all()) return wrong("normalisation.scale", "0 or less", "positive numbers");
  if (Status status = validate_trend(data.trend); !status) return status;
  if (Status status = validate_cover(data.cover, n); !status) return status;
  if (data.error_bound) {
    for (const double value :
         {data.error_bound->floor_N, data.error_bound->per_force, data.error_bound->per_distance_N}) {
      if (Status status = validate_not_negative("error_bound", value); !status) return status;
    }
  }
  if (data.sensor) {
    for (const double value : {data.sensor->encoder_step_m, data.sensor->position_noise_m}) {
      if (Status status = validate_not_negative("sensor", value); !status) return status;
    }
  }
  for (const auto& [value, field] :
       {std::pair{data.correction_limit_N, "correction_limit_N"}, std::pair{data.largest_force_N, "largest_force_N"},
        std::pair{data.jnd.offset_N, "jnd.offset_N"}, std::pair{data.jnd.weber_fraction, "jnd.weber_fraction"}}) {
    if (Status status = validate_not_negative(field, value); !status) return status;
  }
  if (!(data.lowest_force_N <= 0.0) || !std::isfinite(data.lowest_force_N)) {
    return wrong("lowest_force_N", std::to_string(data.lowest_force_N), "0 or less");
  }
  if (data.correction == nullptr) return wrong("model", "no correction", "centres, a grid, or the trend alone");
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
  // The guard's leaf is found by steps that wait for one another, while the correction works;
  // the look at its points, for which nothing but a comparison waits, is done while the
  // correction's last roots are. No other order of the four is quicker, some are slower by up
  // to 26 ns (Zen 4).
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
  // A comparison that fails for NaN, so that nothing but a force leaves.
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
