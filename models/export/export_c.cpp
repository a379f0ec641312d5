#include "models/export/export_c.h"

#include <charconv>
#include <cstdlib>
#include <span>

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

// The table `name`, and the text of its functions.
void write_parts(CText& out, const std::string& name, const std::vector<PartRow>& rows, const char* functions) {
  out.table(name + "[][3 + DRIVE_COEFFICIENTS]",
            Eigen::Map<const Eigen::MatrixXd>(rows.front().data(), std::tuple_size_v<PartRow>,
                                              static_cast<Eigen::Index>(rows.size())));
  out.add(functions);
}

// The C expression of a feature. `range`: of its parts among all branches, or all bristles.
std::string value_of(const CText& out, const FeatureSpec& spec, const std::string& value, const std::string& range) {
  switch (spec.kind) {
    case FeatureKind::depth:
      return "present_m";
    case FeatureKind::velocity:
      return "depth_m > R(0.0) ? motion.velocity_m_per_s : R(0.0)";
    case FeatureKind::lowpass_velocity:
      return "first ? R(0.0) : filtered(" + value + ", depth_m - last_depth_m, step_s, " +
             out.number(spec.relaxation_time_s) + ", R(1.0))";
    case FeatureKind::maxwell_spectrum:
      return "branches(" + range + ", step_s, first)";
    case FeatureKind::stops:
    case FeatureKind::creep:
      return "bristles(" + range + ", step_s, first)";
  }
  return "";
}

// "static void update_features(real step_s, int first)": computes value[] from the motion estimate.
// Only text of the program and numbers are written; names from the model file are not.
void write_features(CText& out, const std::vector<FeatureSpec>& features) {
  std::vector<PartRow> branches;
  std::vector<PartRow> bristles;
  std::string body;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const FeatureSpec& spec = features[i];
    const std::size_t begin = is_branch(spec.kind) ? branches.size() : bristles.size();
    for (const FeaturePart& part : std::span(spec.parts).first(spec.part_count)) {
      const double creep = 1.0 / (part.relaxation_time_s * part.threshold_m * part.threshold_m);
      if (is_branch(spec.kind)) branches.push_back(row_of(part.relaxation_time_s, spec.slowing, part.drive));
      if (is_bristle(spec.kind))
        bristles.push_back(row_of(part.threshold_m, spec.kind == FeatureKind::creep ? creep : 0.0, part.drive));
    }
    const std::string range = std::to_string(begin) + ", " + std::to_string(begin + spec.part_count);
    body += "  " + value_text(i) + " = " + value_of(out, spec, value_text(i), range) + "; /* " + feature_name(spec) +
            " */\n";
  }
  const bool branched = !branches.empty();
  out.add(c_source::state);
  out.add("\n/* ---- features ---- */\n\n");
  out.define("DRIVE_COEFFICIENTS", kDriveCoefficients);
  out.define("BRANCHES", branches.size());
  out.define("BRISTLES", bristles.size());
  if (branched || !bristles.empty()) out.add(c_source::curve);
  if (branched || body.find("filtered(") != std::string::npos) out.add(c_source::filter);
  if (branched) write_parts(out, "branch_part", branches, c_source::branches);
  if (!bristles.empty()) write_parts(out, "bristle_part", bristles, c_source::bristles);
  out.add(
      "\n/* `first`: nothing came before, and every filter is at rest. */\n"
      "static void update_features(real step_s, int first) {\n"
      "  const real present_m = larger(R(0.0), motion.estimate_m - SURFACE_POSITION_M);\n"
      "  depth_m = smaller(present_m, DEEPEST_M);\n  (void)step_s;\n  (void)first;\n" +
      body + "  last_depth_m = depth_m;\n}\n");
}

// "static real trend_of(void)": computes newtons from value[].
void write_trend(CText& out, const Trend& trend, const std::vector<FeatureSpec>& features) {
  const TrendInputs inputs(features);
  const auto input = [](std::uint8_t index) { return index == TrendInputs::kNone ? "R(0.0)" : value_text(index); };
  std::string memory = "R(0.0)";
  for (std::size_t i = 0; i < inputs.force_count; ++i) memory += " + " + input(inputs.force[i]);
  out.add("\n/* ---- trend: a nonlinear viscoelastic solid ---- */\n\n");
  out.define("ELASTIC_PIECES", kElasticPieces);
  out.define("REFERENCE_DEPTH_M", trend.reference_depth_m);
  out.define("VELOCITY_LIMIT_M_PER_S", trend.velocity_limit_m_per_s);
  out.define("THINNING_VELOCITY_M_PER_S", trend.thinning_velocity_m_per_s);
  out.define("TREND_DEPTH", input(inputs.depth));
  out.define("TREND_VELOCITY", input(inputs.velocity));
  out.define("TREND_MEMORY", memory);
  out.add(c_source::trend);
  out.list("elastic", trend.elastic.pieces_N);
  out.list("viscosity", trend.viscosity_Ns_per_m);
  out.list("thinning", trend.thinning_Ns_per_m);
  out.add(c_source::trend_of);
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
  out.add("\n/* ---- correction: radial basis functions; a row: the centre, then its weight ---- */\n\n");
  out.define("CENTRES", static_cast<std::size_t>(function.centre_count()));
  out.define("TAIL_DEGREE", static_cast<std::size_t>(tail_degree(function.kernel)));
  out.define("KERNEL", kernel_facts(function.kernel).c_text);
  out.list("tail", function.tail);
  out.table("centres[][FEATURES + 1]", rows);
  out.add(c_source::rbf);
}

void write_grid(CText& out, const VoxelGrid& grid) {
  std::vector<double> nodes;
  std::vector<std::string> sizes;
  for (const std::vector<double>& axis : grid.nodes) {
    sizes.push_back(std::to_string(axis.size()));
    nodes.insert(nodes.end(), axis.begin(), axis.end());
  }
  out.add("\n/* ---- correction: a grid, the last axis fastest ---- */\n\n");
  out.define("CORNERS", std::size_t{1} << grid.nodes.size());
  out.add("static const int axis_size[FEATURES] = {" + joined(sizes) + "};\n");
  out.list("axes", nodes);
  out.list("grid_values", grid.values_N);
  out.add(c_source::grid);
}

// "static real correction_of(const real *u)": newtons, from normalised features.
void write_correction(CText& out, const CorrectionPtr& correction) {
  if (const RbfFunction* function = rbf_of(correction)) return write_rbf(out, *function);
  if (const VoxelGrid* grid = grid_of(correction)) return write_grid(out, *grid);
  if (correction) std::abort();  // a kind without C text: a mistake of the program
  out.add(
      "\n/* no correction: the model is its trend */\n\nstatic real correction_of(const real *u) {\n"
      "  (void)u;\n  return R(0.0);\n}\n");
}

// "static real trust_in(const real *u)": 1 near the data, 0 out of domain.
void write_trust(CText& out, const DomainCover& cover) {
  out.add("\n/* ---- trust: the distance to the nearest of the data ---- */\n\n");
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
  out.add(c_source::trust);
}

// The type `real` and its functions.
void write_precision(CText& out) {
  const std::string type = out.single() ? "float" : "double";
  if (!out.single())
    out.add(
        "#include <float.h>\n#if DBL_MANT_DIG < 53\n"
        "#error \"double has less than 8 bytes here; palpate export --float writes a file in single precision\"\n"
        "#endif\n");
  out.add("typedef " + type + " real;\n");
  for (const auto& [macro, name] : {std::pair{"SQRT", "sqrt"}, {"EXP", "exp"}, {"LOG", "log"}}) {
    const std::string function = std::string(name).append(out.single() ? "f" : "");
    out.add("extern " + type + " " + function + "(" + type + " x);\n");
    out.define(macro, function);
  }
}

void write_constants(CText& out, const ModelData& data) {
  out.add("\n/* ---- the force ---- */\n\n");
  out.define("CORRECTION_LIMIT_N", data.correction_limit_N);
  out.define("LARGEST_FORCE_N", kForceMargin * data.largest_force_N);
  out.define("LOWEST_FORCE_N", data.lowest_force_N);
  out.list("offset", data.offset);
  out.list("inverse_scale", Eigen::VectorXd(data.scale.cwiseInverse()));
}

}  // namespace

std::string export_c(const ModelData& data, const SensorSpec& sensor, bool single_precision) {
  CText out(single_precision);
  out.add("/* Force model " + in_comment(data.name) + ", written by palpate export.\n * Features:");
  for (const FeatureSpec& spec : data.features) out.add(std::string(" ").append(feature_name(spec)));
  out.add(" */\n");
  out.add(c_source::head);
  out.add("\n#ifndef PALPATE_ENCODER_STEP_M\n");
  out.define("PALPATE_ENCODER_STEP_M", sensor.encoder_step_m);
  out.add("#endif\n#ifndef PALPATE_POSITION_NOISE_M\n");
  out.define("PALPATE_POSITION_NOISE_M", sensor.position_noise_m);
  out.add("#endif\n\n");
  write_precision(out);
  out.define("FEATURES", data.features.size());
  out.define("SURFACE_POSITION_M", surface_position_m(data.features));
  const FittedModel model(data);
  out.define("DEPTH_FEATURE", model.depth_feature());
  out.define("DEEPEST_M", std::min(model.deepest_m(), 1e30));  // infinity has no literal in C
  out.define("SHALLOWEST_M", model.shallowest_m());
  out.add(c_source::declarations);
  out.add(c_source::motion_filter);
  write_features(out, data.features);
  write_trend(out, data.trend, data.features);
  write_correction(out, data.correction);
  write_trust(out, data.cover);
  write_constants(out, data);
  out.add(c_source::tick);
  out.add(single_precision ? c_source::step : c_source::time);
  return out.text();
}

}  // namespace palpate
