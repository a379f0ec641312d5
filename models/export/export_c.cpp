#include "models/export/export_c.h"

#include <charconv>
#include <cstdlib>

#include "engine/base/text.h"
#include "models/export/c_sources.h"
#include "models/model/correction.h"

namespace palpate {
namespace {

// C99 text of numbers and tables, in the precision of the exported file.
class CText {
 public:
  explicit CText(bool single_precision) : single_(single_precision) {}

  bool single() const { return single_; }
  const std::string& text() const { return text_; }

  std::string number(double value) const { return literal(value, single_); }

  void add(std::string_view text) { text_ += text; }
  // "#define NAME VALUE".
  void define(const std::string& name, const std::string& value) { add("#define " + name + " " + value + "\n"); }
  void define(const std::string& name, double value) { define(name, number(value)); }
  void define(const std::string& name, std::size_t value) { define(name, std::to_string(value)); }
  // "static const TYPE NAME[] = {...};" of all values, or for a NAME of two dimensions, such as "centres[][3]", with
  // each column of `values` as one row of the table. `type`: real, or float for single precision in any file.
  void table(const std::string& name, const Eigen::MatrixXd& values, const std::string& type = "real") {
    const bool braces = name.find("][") != std::string::npos;
    add("static const " + type + " " + name + " = {\n");
    for (const auto& column : values.colwise()) {
      std::vector<std::string> row;
      for (const double value : column) row.push_back(literal(value, single_ || type == "float"));
      add((braces ? "  {" : "  ") + joined(row) + (braces ? "},\n" : ",\n"));
    }
    add("};\n");
  }
  // The same for a vector or an array of doubles.
  void list(const std::string& name, const auto& values) {
    table(name + "[]", Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  }

 private:
  // The shortest decimal that reads back as the same number. A value too small for a float becomes 0, because a literal
  // that underflows is an error of the compiler.
  static std::string literal(double value, bool single) {
    char buffer[40];
    char* const end = buffer + sizeof buffer;
    const auto written =
        single ? std::to_chars(buffer, end, static_cast<float>(value)) : std::to_chars(buffer, end, value);
    std::string text(buffer, written.ptr);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return single ? text + "F" : text;
  }

  bool single_;
  std::string text_;
};

std::string value_text(std::size_t index) { return std::string("value[").append(std::to_string(index)).append("]"); }

using PartRow = std::array<double, 3 + kDriveCoefficients>;

PartRow row_of(double first, double second, const DriveCurve& drive) {
  PartRow row{first, second, drive.reference_depth_m};
  std::ranges::copy(drive.coefficient_N, row.begin() + 3);
  return row;
}

// The C expression of a feature. `range`: of its parts among all branches, or all bristles.
std::string value_of(FeatureKind kind, const std::string& range) {
  if (kind == FeatureKind::depth) return "present_m";
  if (kind == FeatureKind::velocity) return "depth_m > R(0.0) ? motion.velocity_m_per_s : R(0.0)";
  return (is_bristle(kind) ? "bristles(" : "branches(") + range + ", step_s, first)";
}

// UPDATE_FEATURES, which computes value[] from the motion estimate, and the tables of all parts. Only text of the
// program and numbers are written; names from the model file are not.
void write_features(CText& out, const std::vector<FeatureSpec>& features) {
  std::vector<PartRow> branches;
  std::vector<PartRow> bristles;
  std::string body;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const FeatureSpec& spec = features[i];
    std::vector<PartRow>& rows = is_bristle(spec.kind) ? bristles : branches;
    const std::string begin = std::to_string(rows.size());
    for (const FeaturePart& part : parts_of(spec)) {
      const double creep = 1.0 / (part.relaxation_time_s * part.threshold_m * part.threshold_m);
      rows.push_back(is_bristle(spec.kind)
                         ? row_of(part.threshold_m, spec.kind == FeatureKind::creep ? creep : 0.0, part.drive)
                         : row_of(part.relaxation_time_s, spec.slowing, part.drive));
    }
    body += " \\\n  " + value_text(i) + " = " + value_of(spec.kind, begin + ", " + std::to_string(rows.size())) +
            "; /* " + feature_name(spec) + " */";
  }
  out.define("DRIVE_COEFFICIENTS", kDriveCoefficients);
  out.define("BRANCHES", branches.size());
  out.define("BRISTLES", bristles.size());
  out.define("UPDATE_FEATURES", body);
  for (const auto& [rows, table] : {std::pair{&branches, "branch_part"}, {&bristles, "bristle_part"}}) {
    if (rows->empty()) continue;
    out.table(std::string(table) + "[][3 + DRIVE_COEFFICIENTS]",
              Eigen::Map<const Eigen::MatrixXd>(rows->front().data(), std::tuple_size_v<PartRow>,
                                                static_cast<Eigen::Index>(rows->size())));
  }
}

void write_trend(CText& out, const Trend& trend, const std::vector<FeatureSpec>& features) {
  const TrendInputs inputs(features);
  const auto input = [](std::uint8_t index) { return index == TrendInputs::kNone ? "R(0.0)" : value_text(index); };
  std::string memory = "R(0.0)";
  for (std::size_t i = 0; i < inputs.force_count; ++i) memory += " + " + input(inputs.force[i]);
  out.define("ELASTIC_PIECES", kElasticPieces);
  out.define("REFERENCE_DEPTH_M", trend.reference_depth_m);
  out.define("VELOCITY_LIMIT_M_PER_S", trend.velocity_limit_m_per_s);
  out.define("THINNING_VELOCITY_M_PER_S", trend.thinning_velocity_m_per_s);
  out.define("TREND_DEPTH", input(inputs.depth));
  out.define("TREND_VELOCITY", input(inputs.velocity));
  out.define("TREND_MEMORY", memory);
  out.list("elastic", trend.elastic.pieces_N);
  out.list("viscosity", trend.viscosity_Ns_per_m);
  out.list("thinning", trend.thinning_Ns_per_m);
}

// Replaces characters that are not safe in a C comment.
std::string in_comment(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~' || c == '*' || c == '?' || c == '\\'; }, '_');
  return text;
}

void write_rbf(CText& out, const RbfFunction& function) {
  Eigen::MatrixXd rows(function.dimension() + 1, function.centre_count());
  rows << function.centres, function.weights.transpose();
  out.define("CENTRES", static_cast<std::size_t>(function.centre_count()));
  out.define("TAIL_DEGREE", static_cast<std::size_t>(tail_degree(function.kernel)));
  out.define("KERNEL", kernel_facts(function.kernel).c_text);
  out.list("tail", function.tail);
  out.table("centres[][FEATURES + 1]", rows);
}

void write_grid(CText& out, const VoxelGrid& grid) {
  std::vector<double> nodes;
  std::vector<std::string> sizes;
  for (const std::vector<double>& axis : grid.nodes) {
    sizes.push_back(std::to_string(axis.size()));
    nodes.insert(nodes.end(), axis.begin(), axis.end());
  }
  out.define("CORNERS", std::size_t{1} << grid.nodes.size());
  out.add("static const int axis_size[FEATURES] = {" + joined(sizes) + "};\n");
  out.list("axes", nodes);
  out.list("grid_values", grid.values_N);
}

void write_cover(CText& out, const DomainCover& cover) {
  out.define("COVER_POINTS", static_cast<std::size_t>(cover.points.cols()));
  const CText exact(false);
  out.define("INNER_RADIUS", exact.number(cover.inner_radius));
  out.define("OUTER_RADIUS", exact.number(cover.outer_radius));
  // Compared in single precision, as in the library, whose instructions add a square with one rounding; a sum in double
  // precision with one rounding to single gives the same.
  out.define("ADD_SQUARE(sum, x)",
             out.single() ? "sum += (x) * (x)" : "sum = (float)((double)(x) * (double)(x) + (double)sum)");
  out.table("cover[][FEATURES]", cover.points.unaryExpr([](double x) { return std::abs(x) < 1e-11 ? 0.0 : x; }),
            "float");
}

}  // namespace

std::string export_c(const ModelData& data, const SensorSpec& sensor, bool single_precision) {
  CText out(single_precision);
  out.add("/* Force model " + in_comment(data.name) + ", written by palpate export.\n * Features:");
  for (const FeatureSpec& spec : data.features) out.add(std::string(" ").append(feature_name(spec)));
  out.add(" */\n");
  if (single_precision) out.define("SINGLE_PRECISION", std::string());
  out.add(c_source::head);
  for (const auto& [macro, value] : {std::pair{"PALPATE_ENCODER_STEP_M", sensor.encoder_step_m},
                                     {"PALPATE_POSITION_NOISE_M", sensor.position_noise_m}}) {
    out.add(std::string("#ifndef ") + macro + "\n");
    out.define(macro, value);
    out.add("#endif\n");
  }
  const FittedModel model(data);
  out.define("FEATURES", data.features.size());
  out.define("SURFACE_POSITION_M", surface_position_m(data.features));
  out.define("DEPTH_FEATURE", model.depth_feature());
  out.define("DEEPEST_M", std::min(model.deepest_m(), 1e30));  // infinity has no literal in C
  out.define("SHALLOWEST_M", model.shallowest_m());
  write_features(out, data.features);
  write_trend(out, data.trend, data.features);
  if (const RbfFunction* function = rbf_of(data.correction)) {
    write_rbf(out, *function);
  } else if (const VoxelGrid* grid = grid_of(data.correction)) {
    write_grid(out, *grid);
  } else if (data.correction) {
    std::abort();  // a kind without C text: a mistake of the program
  }
  write_cover(out, data.cover);
  out.define("CORRECTION_LIMIT_N", data.correction_limit_N);
  out.define("LARGEST_FORCE_N", kForceMargin * data.largest_force_N);
  out.define("LOWEST_FORCE_N", data.lowest_force_N);
  out.list("offset", data.offset);
  out.list("inverse_scale", Eigen::VectorXd(data.scale.cwiseInverse()));
  for (const char* text : {c_source::motion_filter, c_source::trend, c_source::model}) out.add(text);
  return out.text();
}

}  // namespace palpate
