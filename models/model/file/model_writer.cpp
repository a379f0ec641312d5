// From ModelData to the text of a model file.
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "engine/base/csv_scanner.h"
#include "models/model/file/model_fields.h"
#include "models/model/file/model_json.h"

namespace palpate {
namespace {

// The shortest decimal, but never "-0": as a JSON integer it would lose its sign.
std::string number(double value) {
  std::string text = shortest(value);
  return text == "-0" ? "-0.0" : text;
}

std::string quoted(const std::string& text) {
  using Json = nlohmann::json;
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

template <typename Values>
std::string list(const Values& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + number(value);
  return "[" + text + "]";
}

// `items`, each on its own line.
std::string lines(const std::vector<std::string>& items) {
  std::string text = "[";
  for (std::size_t i = 0; i < items.size(); ++i) text += (i == 0 ? "\n    " : ",\n    ") + items[i];
  return text + (items.empty() ? "]" : "\n  ]");
}

std::string columns(const Eigen::MatrixXd& matrix) {
  std::vector<std::string> items;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) items.push_back(list(Eigen::VectorXd(matrix.col(j))));
  return lines(items);
}

std::string drive(const DriveCurve& curve) {
  return "{\"reference_depth_m\": " + number(curve.reference_depth_m) +
         ", \"coefficient_N\": " + list(curve.coefficient_N) + "}";
}

std::string parts(const FeatureSpec& spec) {
  std::string text;
  for (std::size_t p = 0; p < spec.part_count; ++p) {
    const FeaturePart& part = spec.parts[p];
    text += p == 0 ? "{" : ", {";
    text += spec.kind == FeatureKind::stops ? "\"threshold_m\": " + number(part.threshold_m)
                                            : "\"relaxation_time_s\": " + number(part.relaxation_time_s);
    text += ", \"drive\": " + drive(part.drive) + "}";
  }
  return "[" + text + "]";
}

std::string features(const std::vector<FeatureSpec>& specs) {
  std::vector<std::string> items;
  for (const FeatureSpec& spec : specs) {
    std::string text = "{\"kind\": " + quoted(std::string(feature_kind_name(spec.kind)));
    if (has_time(spec.kind)) text += ", \"relaxation_time_s\": " + number(spec.relaxation_time_s);
    if (spec.kind == FeatureKind::maxwell_branch) text += ", \"drive\": " + drive(spec.drive);
    if (has_parts(spec.kind)) text += ", \"parts\": " + parts(spec);
    items.push_back(text + "}");
  }
  return lines(items);
}

bool softens(const std::vector<FeatureSpec>& specs) {
  return std::any_of(specs.begin(), specs.end(),
                     [](const FeatureSpec& spec) { return spec.kind == FeatureKind::fading_peak; });
}

std::string softening(const Trend& trend) {
  std::string text;
  for (const DriveCurve& curve : trend.softening) text += (text.empty() ? "" : ", ") + drive(curve);
  return ",\n    \"softening\": [" + text + "]";
}

std::string domain(const ModelData& data) {
  return "{\n    \"lower\": " + list(data.lower) + ",\n    \"upper\": " + list(data.upper) +
         ",\n    \"inner_radius\": " + number(data.cover.inner_radius) +
         ",\n    \"outer_radius\": " + number(data.cover.outer_radius) +
         ",\n    \"points\": " + columns(data.cover.points) + "\n  }";
}

std::string trend(const ModelData& data) {
  const Trend& trend = data.trend;
  return "{\n    \"reference_depth_m\": " + number(trend.reference_depth_m) +
         ",\n    \"elastic_N\": " + list(trend.elastic_N) +
         ",\n    \"viscosity_Ns_per_m\": " + list(trend.viscosity_Ns_per_m) +
         ",\n    \"thinning_Ns_per_m\": " + list(trend.thinning_Ns_per_m) +
         ",\n    \"thinning_velocity_m_per_s\": " + number(trend.thinning_velocity_m_per_s) +
         ",\n    \"velocity_limit_m_per_s\": " + number(trend.velocity_limit_m_per_s) + (softens(data.features) ? softening(trend) : "") + "\n  }";
}

// Axes first, then the values, one line for each run along the last axis.
std::string grid(const VoxelGrid& grid) {
  std::string axes;
  for (const std::vector<double>& axis : grid.nodes) axes += (axes.empty() ? "" : ", ") + list(axis);
  std::string values;
  const std::size_t run = grid.nodes.back().size();
  for (std::size_t i = 0; i < grid.values_N.size(); ++i) {
    values += i == 0 ? "\n    " : (i % run == 0 ? ",\n    " : ", ");
    values += number(grid.values_N[i]);
  }
  return "{\n    \"nodes\": [" + axes + "],\n    \"values_N\": [" + values + "\n  ]}";
}

// The time of a fit in the file: the next of 1, 2, 5, 10, 20, 50 ... seconds, so
// that equal commands write equal bytes unless their times straddle such a step.
// (`fit --json` prints the time itself.)
double stored_seconds(double fit_seconds) {
  for (double decade = 1.0; decade < 1e12; decade *= 10.0) {
    for (const double step : {1.0, 2.0, 5.0}) {
      if (fit_seconds <= step * decade) return step * decade;
    }
  }
  return fit_seconds;
}

std::string provenance(const Provenance& provenance) {
  std::string recordings;
  for (const std::string& name : provenance.recordings) {
    const std::string stem = name.substr(name.find_last_of("/\\") + 1);
    recordings += (recordings.empty() ? "" : ", ") + quoted(stem);
  }
  std::string times;
  for (const RelaxationTime& time : provenance.relaxation_times) {
    times += (times.empty() ? "{" : ", {") + std::string("\"time_s\": ") + number(time.time_s) +
             ", \"standard_error_s\": " + number(time.standard_error_s) + "}";
  }
  const auto count = [](std::uint64_t value) { return std::to_string(value); };
  return "{\n    \"recordings\": [" + recordings + "],\n    \"scene\": " + quoted(provenance.scene) +
         ",\n    \"samples\": " + count(provenance.samples) +
         ",\n    \"contact_samples\": " + count(provenance.contact_samples) +
         ",\n    \"samples_after_reduction\": " + count(provenance.samples_after_reduction) +
         ",\n    \"seed\": " + count(provenance.seed) +
         ",\n    \"fit_seconds\": " + number(stored_seconds(provenance.fit_seconds)) +
         ",\n    \"weighting\": " + quoted(provenance.weighting) +
         ",\n    \"reduction\": " + quoted(provenance.reduction) +
         ",\n    \"relaxation\": " + quoted(provenance.relaxation) +
         ",\n    \"relaxation_times\": [" + times + "],\n    \"training_within_jnd\": " +
         number(provenance.training_within_jnd) + "\n  }";
}

Status check(const ModelData& data) {
  if (Status status = validate_model(data); !status) return status;
  if (const std::string fault = model_name_fault(data.name); !fault.empty()) return Error{"name: " + fault};
  if (!is_known_method(data.method)) {
    return Error{"method: found \"" + data.method + "\", expected one of " + known_methods()};
  }
  const Provenance& from = data.provenance;
  bool plausible = from.fit_seconds >= 0.0 && from.training_within_jnd >= 0.0 && from.training_within_jnd <= 1.0 &&
                   std::isfinite(from.fit_seconds);
  for (const RelaxationTime& time : from.relaxation_times) {
    plausible = plausible && time.time_s > 0.0 && std::isfinite(time.time_s) && time.standard_error_s >= 0.0 &&
                std::isfinite(time.standard_error_s);
  }
  if (!plausible) return Error{"provenance: found a number that is negative or not finite, expected finite ones"};
  return {};
}

}  // namespace

Result<std::string> write_model_text(const ModelData& data) {
  if (const Status status = check(data); !status) return status.error();
  std::vector<std::pair<std::string, std::string>> fields = {
      {"format", quoted("palpate-model")},
      {"version", std::to_string(kModelVersion)},
      {"name", quoted(data.name)},
      {"method", quoted(data.method)},
      {"features", features(data.features)},
      {"normalisation", "{\n    \"offset\": " + list(data.offset) + ",\n    \"scale\": " + list(data.scale) + "\n  }"},
      {"trend", trend(data)},
      {"corrects_trend", data.corrects_trend ? "true" : "false"},
      {"correction_limit_N", number(data.correction_limit_N)},
      {"largest_force_N", number(data.largest_force_N)},
      {"jnd", "{\"offset_N\": " + number(data.jnd.offset_N) +
                  ", \"weber_fraction\": " + number(data.jnd.weber_fraction) + "}"},
      {"provenance", provenance(data.provenance)},
      {"domain", domain(data)}};
  if (data.rbf) {
    fields.emplace_back("kernel", quoted(std::string(kernel_name(data.rbf->kernel))));
    fields.emplace_back("tail", list(data.rbf->tail));
    fields.emplace_back("centres", columns(data.rbf->centres));
    std::vector<std::string> weights;
    for (const double weight : data.rbf->weights) weights.push_back(number(weight));
    fields.emplace_back("weights", lines(weights));
  } else {
    fields.emplace_back("grid", grid(*data.grid));
  }
  std::string text = "{";
  for (const auto& [key, value] : fields) text += (text.size() == 1 ? "\n  \"" : ",\n  \"") + key + "\": " + value;
  return text + "\n}\n";
}

}  // namespace palpate
