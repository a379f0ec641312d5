#include "models/export/feature_c.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <tuple>

#include "models/export/c_sources.h"

namespace palpate {
namespace {

std::string value_text(std::size_t index) { return std::string("value[").append(std::to_string(index)).append("]"); }

using PartRow = std::array<double, 3 + kDriveCoefficients + kDriveKnots>;

PartRow row_of(double first, double second, const DriveCurve& drive) {
  PartRow row{first, second, drive.reference_depth_m};
  std::ranges::copy(drive.coefficient_N, row.begin() + 3);
  if (drive.has_knots) std::ranges::copy(drive.knot_N, row.begin() + 3 + kDriveCoefficients);
  return row;
}

void write_parts(CText& out, const std::string& name, const std::vector<PartRow>& rows) {
  out.table(name + "[][3 + DRIVE_COEFFICIENTS + DRIVE_KNOTS]",
            Eigen::Map<const Eigen::MatrixXd>(rows.front().data(), std::tuple_size_v<PartRow>,
                                              static_cast<Eigen::Index>(rows.size())));
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
      return "branches(" + range + ", step_s, first, s)";
    case FeatureKind::stops:
    case FeatureKind::creep:
      return "bristles(" + range + ", step_s, first)";
    case FeatureKind::surface_lag:
      return "s - depth_m";
  }
  return "";
}

}  // namespace

// Only text of the program and numbers are written; names from the model file are not.
void write_features(CText& out, const std::vector<FeatureSpec>& features) {
  std::vector<PartRow> branches;
  std::vector<PartRow> bristles;
  std::vector<PartRow> elastic;  // of a surface lag
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
    if (spec.kind == FeatureKind::surface_lag) elastic.push_back(row_of(0.0, 0.0, spec.drive));
    const std::string range = std::to_string(begin) + ", " + std::to_string(begin + spec.part_count);
    body += "  " + value_text(i) + " = " + value_of(out, spec, value_text(i), range) + "; /* " + feature_name(spec) +
            " */\n";
  }
  // Without branches the elastic response alone never holds the surface above the tool.
  const bool lags = !elastic.empty() && !branches.empty();
  if (!branches.empty()) out.add("\ntypedef real HELD_N(real surface_m);\n");
  if (!branches.empty()) out.add(c_source::surface);
  out.add(c_source::state);
  out.add("\n/* ---- features ---- */\n\n");
  out.define("DRIVE_COEFFICIENTS", kDriveCoefficients);
  out.define("DRIVE_KNOTS", kDriveKnots);
  out.define("BRANCHES", branches.size());
  out.define("BRISTLES", bristles.size());
  if (!branches.empty() || !bristles.empty()) out.add(c_source::curve);
  if (!branches.empty() || body.find("filtered(") != std::string::npos) out.add(c_source::filter);
  if (!branches.empty()) write_parts(out, "branch_part", branches);
  if (!branches.empty()) out.add(c_source::branches);
  if (lags) write_parts(out, "surface_elastic", elastic);
  if (lags) out.add(c_source::surface_lag);
  if (!bristles.empty()) write_parts(out, "bristle_part", bristles);
  if (!bristles.empty()) out.add(c_source::bristles);
  out.add(
      "\n/* `first`: nothing came before, and every filter is at rest. */\n"
      "static void update_features(real step_s, int first) {\n  real s;\n"
      "  const real present_m = larger(R(0.0), motion.estimate_m - SURFACE_POSITION_M);\n"
      "  depth_m = smaller(present_m, DEEPEST_M);\n  s = " +
      std::string(lags ? "first ? depth_m : surface_above(step_s)" : "depth_m") +
      ";\n  (void)step_s;\n  (void)first;\n" + body + "  last_depth_m = depth_m;\n  surface_m = s;\n}\n");
}

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

}  // namespace palpate
