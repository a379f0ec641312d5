// From the text of a model file to ModelData. The text may come from anywhere,
// so nothing in it is believed before it was checked.
#include <algorithm>
#include <cmath>
#include <exception>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "engine/base/csv_scanner.h"
#include "engine/json/json_fields.h"
#include "models/model/file/json_arrays.h"
#include "models/model/file/model_fields.h"
#include "models/model/file/model_json.h"

namespace palpate {
namespace {

constexpr const char* kFitAgain = "; fit the model again";
constexpr const char* kDamaged = "; the file is damaged: copy it again or fit the model again";

class ModelReader : private JsonFields {
 public:
  ModelReader(std::string_view text, const std::string& path)
      : JsonFields(text, path, kFitAgain), text_(text), path_(path) {}

  Result<ModelData> read() {
    const Result<nlohmann::json> document = parse_json(text_, path_, kModelNesting, {kFitAgain, kDamaged});
    if (!document) return document.error();
    read_document({&*document, ""});
    if (error()) return *error();
    if (const Status status = validate_model(data_); !status) {
      return Error{path_ + ": " + status.error().message + kFitAgain};
    }
    return std::move(data_);
  }

 private:
  template <std::size_t n>
  void coefficients(const JsonNode& object, const char* key, std::array<double, n>& values) {
    fill(member(object, key, "a list of numbers"), n, "coefficients", values.data());
  }

  Eigen::Index dimension() const { return static_cast<Eigen::Index>(data_.features.size()); }

  void read_document(const JsonNode& top) {
    if (!read_format(top)) return;
    read_names(top);
    const std::size_t named = error_count();
    read_features(top);
    if (error_count() > named) return;  // every size below depends on the features
    const std::string per_feature = "numbers, one per feature";
    const JsonNode normalisation = member(top, "normalisation", "an object with offset and scale");
    data_.offset = read_vector(*this, normalisation, "offset", dimension(), per_feature);
    data_.scale = read_vector(*this, normalisation, "scale", dimension(), per_feature);
    read_trend(member(top, "trend", "an object"));
    data_.corrects_trend = boolean(top, "corrects_trend");
    data_.correction_limit_N = number(top, "correction_limit_N", Sign::kNotNegative);
    data_.largest_force_N = number(top, "largest_force_N", Sign::kNotNegative);
    if (optional_member(top, "lowest_force_N").value != nullptr) data_.lowest_force_N = number(top, "lowest_force_N");
    const JsonNode jnd = member(top, "jnd", "an object with offset_N and weber_fraction");
    data_.jnd.offset_N = number(jnd, "offset_N", Sign::kPositive);
    data_.jnd.weber_fraction = number(jnd, "weber_fraction", Sign::kNotNegative);
    read_provenance(member(top, "provenance", "an object"));
    const JsonNode domain = member(top, "domain", "an object");
    data_.lower = read_vector(*this, domain, "lower", dimension(), per_feature);
    data_.upper = read_vector(*this, domain, "upper", dimension(), per_feature);
    data_.cover.inner_radius = number(domain, "inner_radius", Sign::kNotNegative);
    data_.cover.outer_radius = number(domain, "outer_radius", Sign::kPositive);
    data_.cover.points = read_points(*this, domain, "points", dimension());
    if (top.value->contains("error_bound")) read_error_bound(member(top, "error_bound", "an object"));
    if (top.value->contains("sensor")) read_sensor(member(top, "sensor", "an object"));
    read_correction(top);
    // After another error not all that may be there was asked for.
    if (error_count() == 0) refuse_unknown(top);
  }

  bool read_format(const JsonNode& top) {
    const char* advice = "; name a file that palpate fit wrote";
    const JsonNode format = optional_member(top, "format");
    if (format.value == nullptr || *format.value != "palpate-model") {
      const bool none = format.value == nullptr;
      complain(none ? "" : format.pointer,
               (none ? "found no \"format\"" : found(*format.value)) + ", expected \"palpate-model\"", advice);
      return false;
    }
    const JsonNode version = member(top, "version", std::to_string(kModelVersion));
    if (version.value != nullptr && *version.value != kModelVersion) {
      complain(version.pointer, found(*version.value) + ", expected " + std::to_string(kModelVersion),
               "; fit the model again with this program, or read it with the one that wrote it");
    }
    return !error();
  }

  void read_names(const JsonNode& top) {
    data_.name = text(top, "name");
    if (const std::string fault = model_name_fault(data_.name); !fault.empty()) complain("/name", fault);
    data_.method = text(top, "method");
    if (const std::string fault = model_name_fault(data_.method); !fault.empty()) complain("/method", fault);
  }

  void read_features(const JsonNode& top) {
    const std::string expected = "a list of 1 to " + std::to_string(kMaxFeatures) + " features";
    const JsonNode node = list(top, "features", expected);
    if (node.value == nullptr) return;
    if (node.value->empty() || node.value->size() > kMaxFeatures) {
      complain(node.pointer, found(*node.value) + ", expected " + expected);
      return;
    }
    for (std::size_t i = 0; i < node.value->size(); ++i) {
      read_feature(entry(node, i));
    }
  }

  void read_feature(const JsonNode& node) {
    FeatureSpec spec;
    const JsonNode kind = member(node, "kind", "a text");
    if (kind.value != nullptr && *kind.value == "fading_peak") {
      complain(kind.pointer, "found \"fading_peak\", a feature that fits no longer use; fit again (palpate fit)");
    } else {
      std::vector<std::string> names;
      for (const FeatureKindFacts& one : kFeatureKinds) names.emplace_back(one.name);
      if (const auto known = choice(kind, names)) spec.kind = static_cast<FeatureKind>(*known);
    }
    if (has_time(spec.kind)) spec.relaxation_time_s = number(node, "relaxation_time_s", Sign::kPositive);
    if (is_branch(spec.kind) && optional_member(node, "slowing").value != nullptr)
      spec.slowing = number(node, "slowing");
    if (spec.kind == FeatureKind::depth && optional_member(node, "surface_position_m").value != nullptr) {
      spec.surface_position_m = number(node, "surface_position_m");
    }
    if (has_drive(spec.kind)) spec.drive = drive_member(node, "drive");
    if (has_parts(spec.kind)) read_parts(node, spec);
    data_.features.push_back(spec);
  }

  DriveCurve read_drive(const JsonNode& node) {
    DriveCurve drive;
    drive.reference_depth_m = number(node, "reference_depth_m", Sign::kPositive);
    coefficients(node, "coefficient_N", drive.coefficient_N);
    drive.has_knots = optional_member(node, "knot_N").value != nullptr;
    if (drive.has_knots) coefficients(node, "knot_N", drive.knot_N);
    return drive;
  }
  DriveCurve drive_member(const JsonNode& node, const char* key) {
    return read_drive(member(node, key, "an object with reference_depth_m and coefficient_N"));
  }

  void read_sensor(const JsonNode& node) {
    PositionSensor sensor;
    sensor.encoder_step_m = number(node, "encoder_step_m", Sign::kNotNegative);
    sensor.position_noise_m = number(node, "position_noise_m", Sign::kNotNegative);
    data_.sensor = sensor;
  }

  void read_error_bound(const JsonNode& node) {
    ErrorBound bound;
    bound.floor_N = number(node, "floor_N", Sign::kNotNegative);
    bound.per_force = number(node, "per_force", Sign::kNotNegative);
    bound.per_distance_N = number(node, "per_distance_N", Sign::kNotNegative);
    data_.error_bound = bound;
  }

  void read_parts(const JsonNode& node, FeatureSpec& spec) {
    const std::string expected = "a list of 1 to " + std::to_string(kMaxFeatureParts) + " parts";
    const JsonNode parts = list(node, "parts", expected);
    if (parts.value == nullptr) return;
    if (parts.value->empty() || parts.value->size() > kMaxFeatureParts) {
      complain(parts.pointer, found(*parts.value) + ", expected " + expected);
      return;
    }
    spec.part_count = parts.value->size();
    for (std::size_t p = 0; p < spec.part_count; ++p) {
      const JsonNode part = entry(parts, p);
      if (is_bristle(spec.kind)) spec.parts[p].threshold_m = number(part, "threshold_m", Sign::kPositive);
      if (spec.kind != FeatureKind::stops) {
        spec.parts[p].relaxation_time_s = number(part, "relaxation_time_s", Sign::kPositive);
      }
      spec.parts[p].drive = drive_member(part, "drive");
    }
  }

  void read_trend(const JsonNode& node) {
    data_.trend.reference_depth_m = number(node, "reference_depth_m", Sign::kPositive);
    coefficients(node, "elastic_N", data_.trend.elastic_N);
    data_.trend.has_elastic_knots = optional_member(node, "elastic_knot_N").value != nullptr;
    if (data_.trend.has_elastic_knots) coefficients(node, "elastic_knot_N", data_.trend.elastic_knot_N);
    coefficients(node, "viscosity_Ns_per_m", data_.trend.viscosity_Ns_per_m);
    coefficients(node, "thinning_Ns_per_m", data_.trend.thinning_Ns_per_m);
    data_.trend.thinning_velocity_m_per_s = number(node, "thinning_velocity_m_per_s", Sign::kPositive);
    data_.trend.velocity_limit_m_per_s = number(node, "velocity_limit_m_per_s", Sign::kNotNegative);
  }

  // Exactly one of the fields that tell the kinds of correction apart.
  void read_correction(const JsonNode& top) {
    std::vector<const CorrectionKind*> present;
    std::string known;
    for (const CorrectionKind& kind : correction_kinds()) {
      known += (known.empty() ? "" : ", ") + quoted(kind);
      if (top.value->contains(kind.key)) present.push_back(&kind);
    }
    if (present.size() > 1) {
      complain("", "found both " + quoted(*present[0]) + " and " + quoted(*present[1]) + ", expected one of them");
    } else if (present.empty()) {
      complain("", "found none of " + known + ", expected one of them");
    } else {
      data_.correction = present[0]->read(*this, top, static_cast<int>(dimension()));
    }
  }

  static std::string quoted(const CorrectionKind& kind) { return std::string("\"").append(kind.key).append("\""); }

  // Models of positions as recorded have no such list.
  void read_surfaces(const JsonNode& provenance) {
    if (optional_member(provenance, "surfaces").value == nullptr) return;
    const JsonNode surfaces = list(provenance, "surfaces", "a list");
    for (std::size_t i = 0; surfaces.value != nullptr && i < surfaces.value->size(); ++i) {
      const JsonNode node = entry(surfaces, i);
      RecordingSurface surface;
      surface.name = text(node, "name");
      surface.offset_m = number(node, "surface_offset_m");
      surface.force_zero_N = number(node, "force_zero_N");
      if (optional_member(node, "force_lag_s").value != nullptr) surface.lag_s = number(node, "force_lag_s");
      surface.standard_error_m = std::numeric_limits<double>::infinity();
      if (optional_member(node, "standard_error_m").value != nullptr) {
        surface.standard_error_m = number(node, "standard_error_m", Sign::kNotNegative);
      }
      data_.provenance.surfaces.push_back(std::move(surface));
    }
  }

  void read_provenance(const JsonNode& node) {
    Provenance& from = data_.provenance;
    const JsonNode recordings = list(node, "recordings", "a list of names");
    for (std::size_t i = 0; recordings.value != nullptr && i < recordings.value->size(); ++i) {
      const JsonNode name = entry(recordings, i);
      if (!name.value->is_string()) return complain(name.pointer, found(*name.value) + ", expected a text");
      from.recordings.push_back(name.value->get<std::string>());
    }
    from.scene = text(node, "scene");
    from.samples = count(node, "samples");
    from.contact_samples = count(node, "contact_samples");
    from.samples_after_reduction = count(node, "samples_after_reduction");
    from.seed = count(node, "seed");
    from.weighting = text(node, "weighting");
    from.reduction = text(node, "reduction");
    from.relaxation = text(node, "relaxation");
    read_surfaces(node);
    from.training_within_jnd = number(node, "training_within_jnd", Sign::kNotNegative);
    optional_member(node, "fit_seconds");  // older files
    const JsonNode times = list(node, "relaxation_times", "a list");
    for (std::size_t i = 0; times.value != nullptr && i < times.value->size(); ++i) {
      const JsonNode time = entry(times, i);
      from.relaxation_times.push_back(
          {number(time, "time_s", Sign::kPositive), number(time, "standard_error_s", Sign::kNotNegative)});
    }
  }

  std::string_view text_;
  const std::string& path_;
  ModelData data_;
};

}  // namespace

Result<ModelData> read_model_text(std::string_view text, const std::string& path) {
  try {
    return ModelReader(text, path).read();
  } catch (const std::bad_alloc&) {
    return Error{path + ": found more data than memory holds, expected a model file" + kDamaged};
  } catch (const std::exception& error) {
    return Error{path + ": " + error.what()};
  }
}

}  // namespace palpate
