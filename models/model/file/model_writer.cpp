// From ModelData to the text of a model file.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "models/model/file/json_text.h"
#include "models/model/file/model_fields.h"
#include "models/model/file/model_json.h"

namespace palpate {
namespace {

std::string drive(const DriveCurve& curve) {
  return "{\"reference_depth_m\": " + json_number(curve.reference_depth_m) +
         ", \"coefficient_N\": " + json_list(curve.coefficient_N) +
         (curve.has_knots ? ", \"knot_N\": " + json_list(curve.knot_N) : "") + "}";
}

std::string parts(const FeatureSpec& spec) {
  std::string text;
  for (std::size_t p = 0; p < spec.part_count; ++p) {
    const FeaturePart& part = spec.parts[p];
    text += p == 0 ? "{" : ", {";
    if (is_bristle(spec.kind)) text += "\"threshold_m\": " + json_number(part.threshold_m) + ", ";
    if (spec.kind != FeatureKind::stops) {
      text += "\"relaxation_time_s\": " + json_number(part.relaxation_time_s) + ", ";
    }
    text += "\"drive\": " + drive(part.drive) + "}";
  }
  return "[" + text + "]";
}

std::string features(const std::vector<FeatureSpec>& specs) {
  std::vector<std::string> items;
  for (const FeatureSpec& spec : specs) {
    std::string text = "{\"kind\": " + json_quoted(std::string(facts_of(spec.kind).name));
    if (has_time(spec.kind)) text += ", \"relaxation_time_s\": " + json_number(spec.relaxation_time_s);
    if (spec.surface_position_m != 0.0) text += ", \"surface_position_m\": " + json_number(spec.surface_position_m);
    if (is_branch(spec.kind) && spec.slowing != 0.0) text += ", \"slowing\": " + json_number(spec.slowing);
    if (has_drive(spec.kind)) text += ", \"drive\": " + drive(spec.drive);
    if (has_parts(spec.kind)) text += ", \"parts\": " + parts(spec);
    items.push_back(text + "}");
  }
  return json_lines(items);
}

std::string error_bound(const ErrorBound& bound) {
  return "{\"floor_N\": " + json_number(bound.floor_N) + ", \"per_force\": " + json_number(bound.per_force) +
         ", \"per_distance_N\": " + json_number(bound.per_distance_N) + "}";
}

std::string domain(const ModelData& data) {
  return "{\n    \"lower\": " + json_list(data.lower) + ",\n    \"upper\": " + json_list(data.upper) +
         ",\n    \"inner_radius\": " + json_number(data.cover.inner_radius) +
         ",\n    \"outer_radius\": " + json_number(data.cover.outer_radius) +
         ",\n    \"points\": " + json_columns(data.cover.points) + "\n  }";
}

std::string trend(const ModelData& data) {
  const Trend& trend = data.trend;
  return "{\n    \"reference_depth_m\": " + json_number(trend.reference_depth_m) +
         ",\n    \"elastic_N\": " + json_list(trend.elastic_N) +
         (trend.has_elastic_knots ? ",\n    \"elastic_knot_N\": " + json_list(trend.elastic_knot_N) : "") +
         ",\n    \"viscosity_Ns_per_m\": " + json_list(trend.viscosity_Ns_per_m) +
         ",\n    \"thinning_Ns_per_m\": " + json_list(trend.thinning_Ns_per_m) +
         ",\n    \"thinning_velocity_m_per_s\": " + json_number(trend.thinning_velocity_m_per_s) +
         ",\n    \"velocity_limit_m_per_s\": " + json_number(trend.velocity_limit_m_per_s) + "\n  }";
}

// File name without its folders.
std::string stem_of(const std::string& name) { return name.substr(name.find_last_of("/\\") + 1); }

// Nothing for positions as recorded.
std::string surfaces(const std::vector<RecordingSurface>& all) {
  std::vector<std::string> items;
  for (const RecordingSurface& one : all) {
    std::string text =
        "{\"name\": " + json_quoted(stem_of(one.name)) + ", \"surface_offset_m\": " + json_number(one.offset_m);
    if (std::isfinite(one.standard_error_m)) text += ", \"standard_error_m\": " + json_number(one.standard_error_m);
    text += ", \"force_zero_N\": " + json_number(one.force_zero_N);
    if (one.lag_s != 0.0) text += ", \"force_lag_s\": " + json_number(one.lag_s);
    items.push_back(text + "}");
  }
  return items.empty() ? "" : ",\n    \"surfaces\": " + json_lines(items);
}

std::string sensor(const PositionSensor& sensor) {
  return "{\"encoder_step_m\": " + json_number(sensor.encoder_step_m) +
         ", \"position_noise_m\": " + json_number(sensor.position_noise_m) + "}";
}

std::string provenance(const Provenance& provenance) {
  std::string recordings;
  for (const std::string& name : provenance.recordings) {
    recordings += (recordings.empty() ? "" : ", ") + json_quoted(stem_of(name));
  }
  std::string times;
  for (const RelaxationTime& time : provenance.relaxation_times) {
    times += (times.empty() ? "{" : ", {") + std::string("\"time_s\": ") + json_number(time.time_s) +
             ", \"standard_error_s\": " + json_number(time.standard_error_s) + "}";
  }
  const auto count = [](std::uint64_t value) { return std::to_string(value); };
  return "{\n    \"recordings\": [" + recordings + "]" + surfaces(provenance.surfaces) +
         ",\n    \"scene\": " + json_quoted(provenance.scene) + ",\n    \"samples\": " + count(provenance.samples) +
         ",\n    \"contact_samples\": " + count(provenance.contact_samples) +
         ",\n    \"samples_after_reduction\": " + count(provenance.samples_after_reduction) +
         ",\n    \"seed\": " + count(provenance.seed) + ",\n    \"weighting\": " + json_quoted(provenance.weighting) +
         ",\n    \"reduction\": " + json_quoted(provenance.reduction) +
         ",\n    \"relaxation\": " + json_quoted(provenance.relaxation) + ",\n    \"relaxation_times\": [" + times +
         "],\n    \"training_within_jnd\": " + json_number(provenance.training_within_jnd) + "\n  }";
}

Status check(const ModelData& data) {
  if (Status status = validate_model(data); !status) return status;
  if (const std::string fault = model_name_fault(data.name); !fault.empty()) return Error{"name: " + fault};
  if (const std::string fault = model_name_fault(data.method); !fault.empty()) return Error{"method: " + fault};
  const Provenance& from = data.provenance;
  bool plausible = from.training_within_jnd >= 0.0 && from.training_within_jnd <= 1.0;
  for (const RelaxationTime& time : from.relaxation_times) {
    plausible = plausible && time.time_s > 0.0 && std::isfinite(time.time_s) && time.standard_error_s >= 0.0 &&
                std::isfinite(time.standard_error_s);
  }
  for (const RecordingSurface& surface : from.surfaces) {
    plausible = plausible && std::isfinite(surface.offset_m) && std::isfinite(surface.force_zero_N) &&
                surface.standard_error_m >= 0.0;
  }
  if (!plausible) return Error{"provenance: found a number that is negative or not finite, expected finite ones"};
  return {};
}

}  // namespace

Result<std::string> write_model_text(const ModelData& data) {
  if (const Status status = check(data); !status) return status.error();
  FileFields fields = {{"format", json_quoted("palpate-model")},
                       {"version", std::to_string(kModelVersion)},
                       {"name", json_quoted(data.name)},
                       {"method", json_quoted(data.method)},
                       {"features", features(data.features)},
                       {"normalisation", "{\n    \"offset\": " + json_list(data.offset) +
                                             ",\n    \"scale\": " + json_list(data.scale) + "\n  }"},
                       {"trend", trend(data)},
                       {"corrects_trend", data.corrects_trend ? "true" : "false"},
                       {"correction_limit_N", json_number(data.correction_limit_N)},
                       {"largest_force_N", json_number(data.largest_force_N)},
                       {"jnd", "{\"offset_N\": " + json_number(data.jnd.offset_N) +
                                   ", \"weber_fraction\": " + json_number(data.jnd.weber_fraction) + "}"},
                       {"provenance", provenance(data.provenance)},
                       {"domain", domain(data)}};
  if (data.lowest_force_N < 0.0) fields.emplace_back("lowest_force_N", json_number(data.lowest_force_N));
  if (data.sensor) fields.emplace_back("sensor", sensor(*data.sensor));
  if (data.error_bound) fields.emplace_back("error_bound", error_bound(*data.error_bound));
  for (auto& field : data.correction->file_fields()) fields.push_back(std::move(field));
  std::string text = "{";
  for (const auto& [key, value] : fields) text += (text.size() == 1 ? "\n  \"" : ",\n  \"") + key + "\": " + value;
  return text + "\n}\n";
}

}  // namespace palpate
