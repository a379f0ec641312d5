#include "models/export/export_c.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/base/text.h"
#include "models/export/c_sources.h"
#include "models/export/feature_c.h"
#include "models/model/grid/voxel_grid.h"
#include "models/model/rbf/rbf_evaluate.h"

namespace palpate {
namespace {

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
  out.define("MOTION_STATES", std::size_t{3});
  out.define("FEATURES", data.features.size());
  out.define("SURFACE_POSITION_M", surface_position_m(data.features));
  // A press deeper than the recorded ones, as in the library. Infinity has no literal in C.
  std::size_t depth = 0;
  const double deepest_m = std::min(deepest_in_domain_m(data, depth), 1e30);
  out.define("DEPTH_FEATURE", depth);
  out.define("DEEPEST_M", deepest_m);
  out.define("SHALLOWEST_M", shallowest_in_domain_m(data));
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
