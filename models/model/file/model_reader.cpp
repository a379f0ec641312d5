// From the text of a model file to ModelData. The text may come from anywhere,
// so nothing in it is believed before it was checked.
#include <cmath>
#include <exception>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/base/csv_scanner.h"
#include "engine/json/json_fields.h"
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

  Eigen::VectorXd vector(const JsonNode& object, const char* key, Eigen::Index size, const std::string& words) {
    Eigen::VectorXd values = Eigen::VectorXd::Zero(size);
    fill(member(object, key, "a list of numbers"), static_cast<std::size_t>(size), words, values.data());
    return values;
  }

  // A list of at least one point, a list of one number per feature each.
  Eigen::MatrixXd points(const JsonNode& object, const char* key) {
    const std::string expected = "a list of at least one point";
    const JsonNode node = list(object, key, expected);
    if (node.value == nullptr) return {};
    if (node.value->empty()) complain(node.pointer, "found an empty list, expected " + expected);
    // Looked at before memory is taken for as many points as there seem to be.
    Eigen::MatrixXd matrix(dimension(), static_cast<Eigen::Index>(node.value->size()));
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      const auto index = static_cast<std::size_t>(j);
      const JsonNode point{&(*node.value)[index], node.pointer + "/" + std::to_string(index)};
      if (!fill(point, data_.features.size(), "numbers, one per feature", matrix.col(j).data())) break;
    }
    return matrix;
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
    data_.offset = vector(normalisation, "offset", dimension(), per_feature);
    data_.scale = vector(normalisation, "scale", dimension(), per_feature);
    read_trend(member(top, "trend", "an object"));
    data_.corrects_trend = boolean(top, "corrects_trend");
    data_.correction_limit_N = number(top, "correction_limit_N", Sign::kNotNegative);
    data_.largest_force_N = number(top, "largest_force_N", Sign::kNotNegative);
    const JsonNode jnd = member(top, "jnd", "an object with offset_N and weber_fraction");
    data_.jnd.offset_N = number(jnd, "offset_N", Sign::kPositive);
    data_.jnd.weber_fraction = number(jnd, "weber_fraction", Sign::kNotNegative);
    read_provenance(member(top, "provenance", "an object"));
    const JsonNode domain = member(top, "domain", "an object");
    data_.lower = vector(domain, "lower", dimension(), per_feature);
    data_.upper = vector(domain, "upper", dimension(), per_feature);
    data_.cover.inner_radius = number(domain, "inner_radius", Sign::kNotNegative);
    data_.cover.outer_radius = number(domain, "outer_radius", Sign::kPositive);
    data_.cover.points = points(domain, "points");
    read_function(top);
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
    if (!is_known_method(data_.method)) {
      complain("/method", "found \"" + printable(data_.method) + "\", expected one of " + known_methods());
    }
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
      read_feature({&(*node.value)[i], node.pointer + "/" + std::to_string(i)});
    }
  }

  void read_feature(const JsonNode& node) {
    const std::string kind = text(node, "kind");
    FeatureSpec spec;
    bool known = false;
    for (const FeatureKind candidate : {FeatureKind::depth, FeatureKind::velocity, FeatureKind::lowpass_velocity,
                                        FeatureKind::maxwell_branch}) {
      if (feature_kind_name(candidate) != kind) continue;
      spec.kind = candidate;
      known = true;
    }
    if (!known) {
      complain(node.pointer + "/kind", "found \"" + printable(kind) +
                                           "\", expected one of depth, velocity, lowpass_velocity, maxwell_branch");
    }
    if (is_filter(spec.kind)) spec.relaxation_time_s = number(node, "relaxation_time_s", Sign::kPositive);
    if (spec.kind == FeatureKind::maxwell_branch) {
      const JsonNode drive = member(node, "drive", "an object with reference_depth_m and coefficient_N");
      spec.drive.reference_depth_m = number(drive, "reference_depth_m", Sign::kPositive);
      coefficients(drive, "coefficient_N", spec.drive.coefficient_N);
    }
    data_.features.push_back(spec);
  }

  void read_trend(const JsonNode& node) {
    data_.trend.reference_depth_m = number(node, "reference_depth_m", Sign::kPositive);
    coefficients(node, "elastic_N", data_.trend.elastic_N);
    coefficients(node, "viscosity_Ns_per_m", data_.trend.viscosity_Ns_per_m);
    coefficients(node, "thinning_Ns_per_m", data_.trend.thinning_Ns_per_m);
    data_.trend.thinning_velocity_m_per_s = number(node, "thinning_velocity_m_per_s", Sign::kPositive);
    data_.trend.velocity_limit_m_per_s = number(node, "velocity_limit_m_per_s", Sign::kNotNegative);
  }

  void read_function(const JsonNode& top) {
    const bool has_grid = top.value->contains("grid");
    if (has_grid == top.value->contains("centres")) {
      complain("", has_grid ? "found both \"centres\" and \"grid\", expected one of them"
                            : "found neither \"centres\" nor \"grid\", expected one of them");
      return;
    }
    if (has_grid) {
      read_grid(member(top, "grid", "an object"));
    } else {
      read_rbf(top);
    }
  }

  void read_rbf(const JsonNode& top) {
    RbfFunction function;
    const std::string name = text(top, "kernel");
    const std::optional<KernelKind> kernel = kernel_from_name(name);
    if (!kernel) {
      std::string known;
      for (const KernelKind kind : kKernelKinds) known += (known.empty() ? "" : ", ") + std::string(kernel_name(kind));
      complain("/kernel", "found \"" + printable(name) + "\", expected one of " + known);
      return;
    }
    function.kernel = *kernel;
    const int coefficients = tail_size(tail_degree(*kernel), static_cast<int>(dimension()));
    function.tail = vector(top, "tail", coefficients, "coefficients");
    function.centres = points(top, "centres");
    function.weights = vector(top, "weights", function.centre_count(), "numbers, one per centre");
    data_.rbf = std::move(function);
  }

  void read_grid(const JsonNode& node) {
    VoxelGrid grid;
    const JsonNode axes = list(node, "nodes", "a list of axes");
    if (axes.value == nullptr) return;
    if (axes.value->size() != data_.features.size()) {
      complain(axes.pointer,
               found(*axes.value) + " axes, expected " + std::to_string(dimension()) + ", one per feature");
      return;
    }
    const JsonNode values = list(node, "values_N", "a list of numbers");
    if (values.value == nullptr) return;
    std::size_t product = 1;
    for (std::size_t k = 0; k < axes.value->size(); ++k) {
      if (!read_axis({&(*axes.value)[k], axes.pointer + "/" + std::to_string(k)}, grid)) return;
      product *= grid.nodes.back().size();
      // Checked at every step, for the product of eight sizes may wrap around.
      if (product > values.value->size()) break;
    }
    if (product != values.value->size()) {
      complain(values.pointer, found(*values.value) + ", expected as many as the grid has nodes");
      return;
    }
    grid.values_N.resize(product);
    if (fill(values, product, "numbers", grid.values_N.data())) data_.grid = std::move(grid);
  }

  bool read_axis(const JsonNode& node, VoxelGrid& grid) {
    const std::string expected = "at least 2 numbers, each above the last";
    if (!node.value->is_array() || node.value->size() < 2) {
      complain(node.pointer, found(*node.value) + ", expected " + expected);
      return false;
    }
    std::vector<double> axis(node.value->size());
    if (!fill(node, axis.size(), "numbers", axis.data())) return false;
    for (std::size_t i = 1; i < axis.size(); ++i) {
      if (axis[i - 1] < axis[i]) continue;
      complain(node.pointer + "/" + std::to_string(i), found((*node.value)[i]) + ", expected " + expected);
      return false;
    }
    grid.nodes.push_back(std::move(axis));
    return true;
  }

  void read_provenance(const JsonNode& node) {
    Provenance& from = data_.provenance;
    const JsonNode recordings = list(node, "recordings", "a list of names");
    for (std::size_t i = 0; recordings.value != nullptr && i < recordings.value->size(); ++i) {
      const nlohmann::json& name = (*recordings.value)[i];
      if (!name.is_string()) {
        complain(recordings.pointer + "/" + std::to_string(i), found(name) + ", expected a text");
        return;
      }
      from.recordings.push_back(name.get<std::string>());
    }
    from.scene = text(node, "scene");
    from.samples = count(node, "samples");
    from.contact_samples = count(node, "contact_samples");
    from.samples_after_reduction = count(node, "samples_after_reduction");
    from.seed = count(node, "seed");
    from.fit_seconds = number(node, "fit_seconds", Sign::kNotNegative);
    from.weighting = text(node, "weighting");
    from.reduction = text(node, "reduction");
    from.relaxation = text(node, "relaxation");
    from.training_within_jnd = number(node, "training_within_jnd", Sign::kNotNegative);
    const JsonNode times = list(node, "relaxation_times", "a list");
    for (std::size_t i = 0; times.value != nullptr && i < times.value->size(); ++i) {
      const JsonNode time{&(*times.value)[i], times.pointer + "/" + std::to_string(i)};
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
