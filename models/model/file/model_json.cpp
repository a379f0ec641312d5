// Reads and writes the text of a model file by one description: the describe functions name every member once, in the
// order of the file, to a reader or a writer. The text may come from anywhere, so every value is checked.
#include "models/model/file/model_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "engine/json/json_fields.h"
#include "engine/recording/recording_rules.h"
#include "models/model/file/json_arrays.h"

namespace palpate {
namespace {

constexpr const char* kFitAgain = "; fit the model again";
constexpr const char* kDamaged = "; the file is damaged: copy it again or fit the model again";

// The curve of a branch with a short relaxation time may be large, but it is a force.
constexpr NumberRange kDriveForce_N{-1e9, 1e9};
// Relaxation times that grow by more than exp(20), or 5e8, with the depth indicate a damaged file.
constexpr NumberRange kSlowing{-20.0, 20.0};

// Whether members, or items, are written on a line each or all on one.
enum class Layout { lines, one_line };

// What is wrong with the name of a model or a method, empty if nothing. The name is the header of a column of a CSV
// file, so it must not contain characters that separate columns.
std::string name_fault(const std::string& name) {
  if (name.empty()) return "an empty text";
  if (name.size() > kModelNameBytes) return std::to_string(name.size()) + " bytes";
  const bool plain = std::none_of(name.begin(), name.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == ',' || c == '"';
  });
  return plain ? "" : "a control character, comma or quote";
}

// ---- the description of a model file; `file`: a ModelReader or a ModelWriter ----

void describe_each(auto& file, const char* key, auto& items, std::size_t most, Layout layout, const auto& body) {
  std::size_t count = items.size();
  file.each(key, count, most, layout, [&](std::size_t i) {
    if (i == items.size()) items.emplace_back();
    body(items[i]);
  });
}

void describe_drive(auto& file, DriveCurve& curve) {
  file.object("drive", "an object with reference_depth_m and coefficient_N", Layout::one_line, [&] {
    file.number("reference_depth_m", curve.reference_depth_m, kPositive);
    file.list("coefficient_N", curve.coefficient_N, kDriveForce_N);
    curve.has_knots = file.has("knot_N", curve.has_knots);
    if (curve.has_knots) file.list("knot_N", curve.knot_N, kDriveForce_N);
  });
}

void describe_feature(auto& file, FeatureSpec& spec) {
  file.kind(spec.kind);
  if (has_time(spec.kind)) file.number("relaxation_time_s", spec.relaxation_time_s, kPositive);
  if (spec.kind == FeatureKind::depth && file.has("surface_position_m", spec.surface_position_m != 0.0)) {
    file.number("surface_position_m", spec.surface_position_m);
  }
  if (is_branch(spec.kind) && file.has("slowing", spec.slowing != 0.0)) file.number("slowing", spec.slowing, kSlowing);
  if (has_drive(spec.kind)) describe_drive(file, spec.drive);
  if (!has_parts(spec.kind)) return;
  const auto describe_part = [&](std::size_t p) {
    FeaturePart& part = spec.parts[p];
    if (is_bristle(spec.kind)) file.number("threshold_m", part.threshold_m, kPositive);
    if (spec.kind != FeatureKind::stops) file.number("relaxation_time_s", part.relaxation_time_s, kPositive);
    describe_drive(file, part.drive);
  };
  if (is_branch(spec.kind) && file.has("drive", false)) {  // the only branch, in earlier files
    spec.part_count = 1;
    return describe_part(0);
  }
  file.each("parts", spec.part_count, kMaxFeatureParts, Layout::one_line, describe_part);
}

void describe_trend(auto& file, Trend& trend) {
  file.object("trend", "an object", Layout::lines, [&] {
    file.number("reference_depth_m", trend.reference_depth_m, kPositive);
    if (file.has("elastic_N", false)) {  // of earlier files: powers of u, of which fits used three, and knots
      std::array<double, 6> power_N{};
      std::array<double, 7> knot_N{};
      file.list("elastic_N", power_N);
      if (file.has("elastic_knot_N", false)) file.list("elastic_knot_N", knot_N);
      trend.elastic = spline_from_powers({power_N[0], power_N[1], power_N[2]}, knot_N);
    } else {
      file.list("elastic_pieces_N", trend.elastic.pieces_N);
    }
    file.list("viscosity_Ns_per_m", trend.viscosity_Ns_per_m);
    file.list("thinning_Ns_per_m", trend.thinning_Ns_per_m);
    file.number("thinning_velocity_m_per_s", trend.thinning_velocity_m_per_s, kPositive);
    file.number("velocity_limit_m_per_s", trend.velocity_limit_m_per_s, kNotNegative);
  });
}

void describe_surface(auto& file, RecordingSurface& surface) {
  file.text("name", surface.name);
  file.number("surface_offset_m", surface.offset_m);
  if (file.has("standard_error_m", std::isfinite(surface.standard_error_m))) {
    file.number("standard_error_m", surface.standard_error_m, kNotNegative);
  } else {
    surface.standard_error_m = HUGE_VAL;
  }
  file.number("force_zero_N", surface.force_zero_N);
  if (file.has("force_lag_s", surface.lag_s != 0.0)) file.number("force_lag_s", surface.lag_s);
}

void describe_provenance(auto& file, Provenance& from) {
  file.object("provenance", "an object", Layout::lines, [&] {
    file.names("recordings", from.recordings);
    // Models fitted to positions as recorded have no such list.
    if (file.has("surfaces", !from.surfaces.empty())) {
      describe_each(file, "surfaces", from.surfaces, 0, Layout::lines,
                    [&](RecordingSurface& surface) { describe_surface(file, surface); });
    }
    file.text("scene", from.scene);
    file.count("samples", from.samples);
    file.count("contact_samples", from.contact_samples);
    file.count("samples_after_reduction", from.samples_after_reduction);
    file.count("seed", from.seed);
    file.has("fit_seconds", false);  // older files
    file.text("weighting", from.weighting);
    file.text("reduction", from.reduction);
    file.text("relaxation", from.relaxation);
    describe_each(file, "relaxation_times", from.relaxation_times, 0, Layout::one_line, [&](RelaxationTime& time) {
      file.number("time_s", time.time_s, kPositive);
      file.number("standard_error_s", time.standard_error_s, kNotNegative);
    });
    file.number("training_within_jnd", from.training_within_jnd, {0.0, 1.0});
  });
}

void describe_names(auto& file, ModelData& data) {
  file.name("name", data.name);
  file.name("method", data.method);
}

void describe_features(auto& file, ModelData& data) {
  describe_each(file, "features", data.features, kMaxFeatures, Layout::lines,
                [&](FeatureSpec& spec) { describe_feature(file, spec); });
}

// All members whose size depends on the features, and all others except the correction.
void describe_rest(auto& file, ModelData& data) {
  file.object("normalisation", "an object with offset and scale", Layout::lines, [&] {
    file.per_feature("offset", data.offset);
    file.per_feature("scale", data.scale, kPositive);
  });
  describe_trend(file, data.trend);
  file.flag("corrects_trend", data.corrects_trend);
  file.number("correction_limit_N", data.correction_limit_N, {0.0, kMaximumForce_N});
  file.number("largest_force_N", data.largest_force_N, {0.0, kMaximumForce_N});
  file.object("jnd", "an object with offset_N and weber_fraction", Layout::one_line, [&] {
    file.number("offset_N", data.jnd.offset_N, kPositive);
    file.number("weber_fraction", data.jnd.weber_fraction, kNotNegative);
  });
  describe_provenance(file, data.provenance);
  file.object("domain", "an object", Layout::lines, [&] {
    file.per_feature("lower", data.lower);
    file.per_feature("upper", data.upper);
    file.number("inner_radius", data.cover.inner_radius, kNotNegative);
    file.number("outer_radius", data.cover.outer_radius, {data.cover.inner_radius, kLargestNumber, true});
    file.points("points", data.cover.points);
  });
  if (file.has("lowest_force_N", data.lowest_force_N < 0.0)) {
    file.number("lowest_force_N", data.lowest_force_N, {-kMaximumForce_N, 0.0});
  }
  if (file.has("sensor", data.sensor.has_value())) {
    PositionSensor& sensor = data.sensor ? *data.sensor : data.sensor.emplace();
    file.object("sensor", "an object", Layout::one_line, [&] {
      file.number("encoder_step_m", sensor.encoder_step_m, kNotNegative);
      file.number("position_noise_m", sensor.position_noise_m, kNotNegative);
    });
  }
  if (file.has("error_bound", data.error_bound.has_value())) {
    ErrorBound& bound = data.error_bound ? *data.error_bound : data.error_bound.emplace();
    file.object("error_bound", "an object", Layout::one_line, [&] {
      file.number("floor_N", bound.floor_N, kNotNegative);
      file.number("per_force", bound.per_force, kNotNegative);
      file.number("per_distance_N", bound.per_distance_N, kNotNegative);
    });
  }
}

// ---- reading ----

class ModelReader {
 public:
  ModelReader(const nlohmann::json& document, std::string_view text, const std::string& path)
      : fields_(text, path, kFitAgain), top_{&document, ""}, at_(top_) {}

  std::optional<Error> read(ModelData& data) {
    if (!read_format()) return fields_.error();
    describe_names(*this, data);
    const std::size_t named = fields_.error_count();
    describe_features(*this, data);
    if (fields_.error_count() > named) return fields_.error();  // every size below depends on the features
    dimension_ = static_cast<Eigen::Index>(data.features.size());
    describe_rest(*this, data);
    read_correction(data);
    // After another error some known members were not read and would seem unknown.
    if (fields_.error_count() == 0) fields_.refuse_unknown(top_);
    return fields_.error();
  }

  // The members of the object that is being read. `has`: whether there is such a member.
  bool has(const char* key, bool) { return fields_.optional_member(at_, key).value != nullptr; }
  void text(const char* key, std::string& value) { value = fields_.text(at_, key); }
  void name(const char* key, std::string& value) {
    text(key, value);
    const std::string fault = name_fault(value);
    if (fault.empty()) return;
    fields_.complain(std::string("/") + key, "found " + fault + ", expected 1 to " + std::to_string(kModelNameBytes) +
                                                 " bytes without control characters, commas and quotes");
  }
  void flag(const char* key, bool& value) { value = fields_.boolean(at_, key); }
  void count(const char* key, std::uint64_t& value) { value = fields_.count(at_, key); }
  void number(const char* key, double& value, NumberRange range = {}) { value = fields_.number(at_, key, range); }
  template <std::size_t n>
  void list(const char* key, std::array<double, n>& values, NumberRange range = {}) {
    fields_.fill(fields_.member(at_, key, "a list of numbers"), n, "coefficients", values.data(), range);
  }
  void per_feature(const char* key, Eigen::VectorXd& values, NumberRange range = {}) {
    values = read_vector(fields_, at_, key, dimension_, "numbers, one per feature", range);
  }
  void points(const char* key, Eigen::MatrixXd& values) { values = read_points(fields_, at_, key, dimension_); }

  void names(const char* key, std::vector<std::string>& values) {
    const JsonNode list = fields_.list(at_, key, "a list of names");
    for (std::size_t i = 0; list.value != nullptr && i < list.value->size(); ++i) {
      const JsonNode name = JsonFields::entry(list, i);
      if (!name.value->is_string()) return fields_.complain(name.pointer, found(*name.value) + ", expected a text");
      values.push_back(name.value->get<std::string>());
    }
  }

  void kind(FeatureKind& value) {
    const JsonNode node = fields_.member(at_, "kind", "a text");
    if (node.value != nullptr && *node.value == "maxwell_branch") {  // of earlier files
      value = FeatureKind::maxwell_spectrum;
      return;
    }
    std::vector<std::string> names;
    for (const FeatureKindFacts& one : kFeatureKinds) names.emplace_back(one.name);
    if (const auto known = fields_.choice(node, names)) value = static_cast<FeatureKind>(*known);
  }

  void object(const char* key, const char* expected, Layout, const auto& body) {
    inside(fields_.member(at_, key, expected), body);
  }

  // `most`: the largest number of items; 0: any number, or none.
  void each(const char* key, std::size_t& count, std::size_t most, Layout, const auto& body) {
    const std::string expected = most == 0 ? "a list" : "a list of 1 to " + std::to_string(most) + " " + key;
    const JsonNode list = fields_.list(at_, key, expected);
    count = list.value != nullptr ? list.value->size() : 0;
    if (list.value != nullptr && most > 0 && (count == 0 || count > most)) {
      fields_.complain(list.pointer, found(*list.value) + ", expected " + expected);
      count = 0;
    }
    for (std::size_t i = 0; i < count; ++i) inside(JsonFields::entry(list, i), [&] { body(i); });
  }

 private:
  void inside(const JsonNode& node, const auto& body) {
    const JsonNode outer = std::exchange(at_, node);
    body();
    at_ = outer;
  }

  bool read_format() {
    const JsonNode format = fields_.optional_member(top_, "format");
    const bool none = format.value == nullptr;
    if (none || *format.value != "palpate-model") {
      fields_.complain(none ? "" : format.pointer,
                       (none ? "found no \"format\"" : found(*format.value)) + ", expected \"palpate-model\"",
                       "; name a file that palpate fit wrote");
      return false;
    }
    const JsonNode version = fields_.member(top_, "version", std::to_string(kModelVersion));
    if (version.value != nullptr && *version.value != kModelVersion) {
      fields_.complain(version.pointer, found(*version.value) + ", expected " + std::to_string(kModelVersion),
                       "; fit the model again with this program, or read it with the one that wrote it");
    }
    return !fields_.error();
  }

  // Reads the correction from exactly one of the fields that identify its kind.
  void read_correction(ModelData& data) {
    std::vector<const CorrectionKind*> present;
    std::string known, given;
    for (const CorrectionKind& kind : correction_kinds()) {
      const std::string quoted = json_quoted(kind.key);
      known += (known.empty() ? "" : ", ") + quoted;
      if (!top_.value->contains(kind.key)) continue;
      given += (given.empty() ? "" : " and ") + quoted;
      present.push_back(&kind);
    }
    if (present.size() == 1) {
      data.correction = present[0]->read(fields_, top_, static_cast<int>(dimension_));
    } else {
      fields_.complain("", "found " + (given.empty() ? "none" : given) + ", expected one of " + known);
    }
  }

  JsonFields fields_;
  JsonNode top_;
  JsonNode at_;
  Eigen::Index dimension_ = 0;
};

// ---- writing ----

class ModelWriter {
 public:
  bool has(const char*, bool there) { return there; }
  void text(const char* key, const std::string& value) { add(key, json_quoted(value)); }
  void name(const char* key, const std::string& value) { text(key, value); }
  void flag(const char* key, bool value) { add(key, value ? "true" : "false"); }
  void count(const char* key, std::uint64_t value) { add(key, std::to_string(value)); }
  void number(const char* key, double value, NumberRange = {}) { add(key, json_number(value)); }
  void list(const char* key, const auto& values, NumberRange = {}) { add(key, json_list(values)); }
  void per_feature(const char* key, const Eigen::VectorXd& values, NumberRange = {}) { list(key, values); }
  void points(const char* key, const Eigen::MatrixXd& values) { add(key, json_columns(values)); }
  void kind(FeatureKind value) { text("kind", std::string(facts_of(value).name)); }

  void names(const char* key, const std::vector<std::string>& values) {
    std::vector<std::string> quoted;
    for (const std::string& value : values) quoted.push_back(json_quoted(value));
    add(key, json_joined("[", quoted, ", ", "]"));
  }

  void object(const char* key, const char*, Layout layout, const auto& body) {
    add(key, layout == Layout::lines ? members("{\n    ", ",\n    ", "\n  }", body) : members("{", ", ", "}", body));
  }

  void each(const char* key, std::size_t count, std::size_t, Layout layout, const auto& body) {
    std::vector<std::string> items;
    for (std::size_t i = 0; i < count; ++i) items.push_back(members("{", ", ", "}", [&] { body(i); }));
    add(key, layout == Layout::lines ? json_lines(items) : json_joined("[", items, ", ", "]"));
  }

  void add(const std::string& key, const std::string& value) {
    members_.push_back(std::string("\"").append(key).append("\": ").append(value));
  }
  // The text of the object whose members `body` adds.
  std::string members(const char* open, const char* between, const char* close, const auto& body) {
    std::vector<std::string> outer = std::exchange(members_, {});
    body();
    std::swap(members_, outer);
    return json_joined(open, outer, between, close);
  }

 private:
  std::vector<std::string> members_;  // of the object that is being written
};

// File name without its folders.
std::string stem_of(const std::string& name) { return name.substr(name.find_last_of("/\\") + 1); }

}  // namespace

Result<ModelData> read_model_text(std::string_view text, const std::string& path) {
  const Result<nlohmann::json> document = parse_json(text, path, kModelNesting, {kFitAgain, kDamaged});
  if (!document) return document.error();
  ModelData data;
  if (const auto error = ModelReader(*document, text, path).read(data)) return *error;
  if (const Status forces = check_forces(data); !forces) return Error{path + ": " + forces.error().message + kFitAgain};
  return data;
}

Result<std::string> write_model_text(const ModelData& data) {
  if (const Status status = check_forces(data); !status) return status.error();
  ModelData written = data;
  for (std::string& name : written.provenance.recordings) name = stem_of(name);
  for (RecordingSurface& surface : written.provenance.surfaces) surface.name = stem_of(surface.name);
  ModelWriter file;
  std::string text = file.members("{\n  ", ",\n  ", "\n}\n", [&] {
    file.text("format", "palpate-model");
    file.add("version", std::to_string(kModelVersion));
    describe_names(file, written);
    describe_features(file, written);
    describe_rest(file, written);
    for (const auto& [key, value] : data.correction->file_fields()) file.add(key, value);
  });
  // What cannot be read is not written.
  if (const auto back = read_model_text(text, "its text"); !back) return back.error();
  return text;
}

}  // namespace palpate
