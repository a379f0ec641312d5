// Describes a model file: names every member once, in the order of the file. `file` is a reader or a writer
// (model_io.cpp), which reads the values from the file or writes them to it.
// Thread guarantee: slow side.
#pragma once

#include <cmath>

#include "engine/json/json_fields.h"
#include "engine/recording/recording.h"
#include "models/model/correction.h"
#include "models/model/fitted_model.h"

namespace palpate::model_file {

// The curve of a branch with a short relaxation time may have values far above the forces of the material.
inline constexpr NumberRange kDriveForce_N{-1e9, 1e9};
// Relaxation times that change by more than a factor of exp(20), or 5e8, with the depth indicate a damaged file.
inline constexpr NumberRange kSlowing{-20.0, 20.0};
// A divisor, in SI units: smaller than a motion or force of any sensor, and so large that quotients have finite
// squares.
inline constexpr NumberRange kDivisor{1e-12, kLargestNumber, true};
inline constexpr const char* kOnePerFeature = "numbers, one per feature";

// False after an error in the list.
bool describe_each(auto& file, const char* key, auto& items, std::size_t most, const auto& body) {
  std::size_t count = items.size();
  return file.each(key, count, most, [&](std::size_t i) {
    if (i == items.size()) items.emplace_back();
    body(items[i]);
  });
}

// A number that is written only if it is not 0.
void describe_unless_0(auto& file, const char* key, double& value, NumberRange range = {}) {
  if (file.has(key, value != 0.0)) file.value(key, value, range);
}

void describe_drive(auto& file, DriveCurve& curve) {
  file.object("drive", "an object with reference_depth_m and coefficient_N", [&] {
    file.value("reference_depth_m", curve.reference_depth_m, kDivisor);
    file.value("coefficient_N", curve.coefficient_N, kDriveForce_N);
  });
}

void describe_feature(auto& file, FeatureSpec& spec) {
  file.choice("kind", spec.kind, kFeatureKinds);
  if (has_time(spec.kind)) file.value("relaxation_time_s", spec.relaxation_time_s, kDivisor);
  if (spec.kind == FeatureKind::depth) describe_unless_0(file, "surface_position_m", spec.surface_position_m);
  if (is_branch(spec.kind)) describe_unless_0(file, "slowing", spec.slowing, kSlowing);
  if (!has_parts(spec.kind)) return;
  const auto describe_part = [&](std::size_t p) {
    FeaturePart& part = spec.parts[p];
    if (is_bristle(spec.kind)) file.value("threshold_m", part.threshold_m, kDivisor);
    if (spec.kind != FeatureKind::stops) file.value("relaxation_time_s", part.relaxation_time_s, kDivisor);
    describe_drive(file, part.drive);
  };
  file.each("parts", spec.part_count, kMaxFeatureParts, describe_part);
}

void describe_trend(auto& file, Trend& trend) {
  file.object("trend", "an object", [&] {
    file.value("reference_depth_m", trend.reference_depth_m, kDivisor);
    file.value("elastic_pieces_N", trend.elastic.pieces_N);
    file.value("viscosity_Ns_per_m", trend.viscosity_Ns_per_m);
    file.value("thinning_Ns_per_m", trend.thinning_Ns_per_m);
    file.value("thinning_velocity_m_per_s", trend.thinning_velocity_m_per_s, kDivisor);
    file.value("velocity_limit_m_per_s", trend.velocity_limit_m_per_s, kNotNegative);
  });
}

void describe_surface(auto& file, RecordingOffset& surface) {
  file.value("name", surface.name);
  file.value("surface_offset_m", surface.offset_m);
  if (file.has("standard_error_m", std::isfinite(surface.standard_error_m)))
    file.value("standard_error_m", surface.standard_error_m, kNotNegative);
  else
    surface.standard_error_m = HUGE_VAL;
  file.value("force_zero_N", surface.force_zero_N);
}

void describe_provenance(auto& file, Provenance& from) {
  file.object("provenance", "an object", [&] {
    file.value("recordings", from.recordings);
    // A model that was not made from recordings has no such list.
    if (file.has("surfaces", !from.offsets.empty()))
      describe_each(file, "surfaces", from.offsets, 0,
                    [&](RecordingOffset& surface) { describe_surface(file, surface); });
    file.value("scene", from.scene);
    file.value("samples", from.samples);
    file.value("contact_samples", from.contact_samples);
    file.value("samples_after_reduction", from.samples_after_reduction);
    file.value("seed", from.seed);
    file.value("weighting", from.weighting);
    file.value("thinning", from.thinning);
    file.value("relaxation", from.relaxation);
    file.value("training_within_jnd", from.training_within_jnd, {0.0, 1.0});
  });
}

void describe_model(auto& file, ModelData& data) {
  file.name("name", data.name);
  file.name("method", data.method);
  // The size of some members depends on the features.
  const auto describe_one = [&](FeatureSpec& spec) { describe_feature(file, spec); };
  if (!describe_each(file, "features", data.features, kMaxFeatures, describe_one)) return;
  const auto dimension = static_cast<Eigen::Index>(data.features.size());
  file.object("normalisation", "an object with offset and scale", [&] {
    file.numbers("offset", data.offset, dimension, kOnePerFeature);
    file.numbers("scale", data.scale, dimension, kOnePerFeature, kDivisor);
  });
  describe_trend(file, data.trend);
  file.value("correction_limit_N", data.correction_limit_N, {0.0, kMaximumForce_N});
  file.value("largest_force_N", data.largest_force_N, {0.0, kMaximumForce_N});
  file.object("jnd", "an object with offset_N and weber_fraction", [&] {
    file.value("offset_N", data.jnd.offset_N, kDivisor);
    file.value("weber_fraction", data.jnd.weber_fraction, kNotNegative);
  });
  describe_provenance(file, data.provenance);
  file.object("domain", "an object", [&] {
    file.numbers("lower", data.lower, dimension, kOnePerFeature);
    file.numbers("upper", data.upper, dimension, kOnePerFeature);
    file.value("inner_radius", data.cover.inner_radius, kNotNegative);
    file.value("outer_radius", data.cover.outer_radius, {data.cover.inner_radius, kLargestNumber, true});
    file.points("points", data.cover.points, dimension);
  });
  if (file.has("recording_ends", !data.ends.empty())) {
    describe_each(file, "recording_ends", data.ends, 0, [&](RecordingEnds& one) {
      file.value("first_position_m", one.first_position_m);
      file.value("last_position_m", one.last_position_m);
      describe_unless_0(file, "first_force_N", one.first_force_N);
      const auto size = static_cast<Eigen::Index>(memory_size(data.features));
      Eigen::VectorXd memory = Eigen::Map<const Eigen::VectorXd>(one.memory.data(), std::ssize(one.memory));
      file.numbers("memory", memory, size, "numbers, one for each low-pass and each part of a feature");
      one.memory.assign(memory.begin(), memory.end());
    });
  }
  describe_unless_0(file, "surface_step_N", data.surface_step_N, kNotNegative);
  describe_unless_0(file, "lowest_force_N", data.lowest_force_N, {-kMaximumForce_N, 0.0});
  if (file.has("sensor", data.sensor.has_value())) {
    SensorSpec& sensor = data.sensor ? *data.sensor : data.sensor.emplace();
    file.object("sensor", "an object", [&] {
      file.value("encoder_step_m", sensor.encoder_step_m, kNotNegative);
      file.value("position_noise_m", sensor.position_noise_m, kNotNegative);
    });
  }
  if (file.has("error_bound", data.error_bound.has_value())) {
    ErrorBound& bound = data.error_bound ? *data.error_bound : data.error_bound.emplace();
    file.object("error_bound", "an object", [&] {
      file.value("floor_N", bound.floor_N, kNotNegative);
      file.value("per_force", bound.per_force, kNotNegative);
      file.value("per_distance_N", bound.per_distance_N, kNotNegative);
      describe_unless_0(file, "surface_error_m", bound.surface_error_m, kNotNegative);
    });
  }
  file.correction(data.correction, dimension);
}

// The members of a correction by radial basis functions.
void describe_rbf(auto& file, RbfFunction& function, Eigen::Index dimension) {
  if (!file.choice("kernel", function.kernel, kKernels)) return;
  const int tail = tail_size(tail_degree(function.kernel), static_cast<int>(dimension));
  file.numbers("tail", function.tail, tail, "coefficients");
  file.points("centres", function.centres, dimension);
  file.numbers("weights", function.weights, function.centre_count(), "numbers, one per centre");
}

}  // namespace palpate::model_file
