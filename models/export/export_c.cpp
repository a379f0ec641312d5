#include "models/export/export_c.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "models/export/feature_c.h"
#include "models/export/motion_filter_c.h"
#include "models/model/grid/voxel_grid.h"
#include "models/model/rbf/rbf_evaluate.h"

namespace palpate {
namespace {

// The size of the state of the motion filter, the depth and the last sample, in numbers.
constexpr std::size_t kMotionNumbers = 2 * (3 + 9 + 1) + 2 + 6;

// Replaces characters that are not safe in a C comment.
std::string in_comment(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~' || c == '*' || c == '?' || c == '\\'; }, '_');
  return text;
}

// Describes the sensor that the file assumes.
std::string sensor_text(const CText& exact, const SensorSpec& sensor) {
  const std::string step =
      sensor.encoder_step_m > 0.0 ? "in steps of " + exact.number(sensor.encoder_step_m) + " m" : "";
  const std::string noise =
      sensor.position_noise_m > 0.0 ? "with a noise of " + exact.number(sensor.position_noise_m) + " m" : "";
  if (step.empty() && noise.empty()) return "exact";
  return step + (step.empty() || noise.empty() ? "" : " ") + noise;
}

std::string head(const ModelData& data, const ExportRequest& request) {
  const std::string real = request.single_precision ? "float" : "double";
  const CText exact(false);
  std::string features;
  for (const FeatureSpec& spec : data.features) features += (features.empty() ? "" : ", ") + feature_name(spec);
  return "/* Force model " + in_comment(data.name) +
         ", written by palpate export. C99; needs sqrt and exp, and log for a thin-plate kernel.\n"
         " * Features: " +
         features +
         "\n"
         " *\n"
         " * " +
         real + " palpate_force(" + real + " time_s, " + real +
         " position_m): the force in N, positive out of the\n"
         " *   material. position_m: as in the recordings, whose undisturbed surface is at\n"
         " *   " +
         exact.number(surface_position_m(data.features)) +
         " m, positive inside. If a value\n"
         " *   is not finite or the time is not later than the last one: 0 N, and the state is kept.\n"
         " * " +
         real + " palpate_force_after(" + real + " step_s, " + real +
         " position_m): the same, `step_s` after the last\n"
         " *   call; better in single precision, where a large time has coarse steps.\n"
         " * int palpate_out_of_domain(void): 1 if the last motion was outside the recorded domain.\n"
         " * void palpate_reset(void): the next sample begins a new contact.\n"
         " *\n"
         " * One tool, one thread: the state is static. For two models in one program compile one\n"
         " * with -Dpalpate_force=other_force and so on.\n"
         " * The positions are assumed to be " +
         sensor_text(exact, request.sensor) +
         ". For another sensor define\n"
         " * PALPATE_ENCODER_STEP_M and PALPATE_POSITION_NOISE_M when compiling: the step of the\n"
         " * positions (0 if there is none) and the standard deviation of the additional noise.\n"
         " * A recording of such positions, without measured velocity or acceleration, gives the\n"
         " * forces of palpate replay.\n"
         " */\n"
         "\n"
         "#ifndef PALPATE_ENCODER_STEP_M\n#define PALPATE_ENCODER_STEP_M " +
         exact.number(request.sensor.encoder_step_m) +
         "\n#endif\n#ifndef PALPATE_POSITION_NOISE_M\n#define PALPATE_POSITION_NOISE_M " +
         exact.number(request.sensor.position_noise_m) + "\n#endif\n\n";
}

constexpr const char* kDoubleC = R"C(typedef double real;
extern double sqrt(double x);
extern double exp(double x);
extern double log(double x);
#define SQRT sqrt
#define EXP exp
#define LOG log
)C";

constexpr const char* kFloatC = R"C(typedef float real;
extern float sqrtf(float x);
extern float expf(float x);
extern float logf(float x);
#define SQRT sqrtf
#define EXP expf
#define LOG logf
)C";

constexpr const char* kMotionStateC = R"C(
static MotionState motion;
static real last_time_s;

static real clamped(real x, real low, real high) { return x < low ? low : (high < x ? high : x); }
static real absolute(real x) { return x < R(0.0) ? -x : x; }
static int finite_number(real x) { return x - x == R(0.0); }
)C";

std::string tail_text(const RbfFunction& function) {
  const int degree = tail_degree(function.kernel);
  std::string text = "  real sum = tail[0];\n  int i, k;\n";
  if (degree >= 1) text += "  for (k = 0; k < FEATURES; ++k) sum += tail[1 + k] * u[k];\n";
  if (degree >= 2) {
    text +=
        "  {\n    const real *quadratic_tail = tail + 1 + FEATURES;\n    for (i = 0; i < FEATURES; ++i) {\n"
        "      real row = R(0.0);\n      for (k = i; k < FEATURES; ++k) row += *quadratic_tail++ * u[k];\n"
        "      sum += row * u[i];\n    }\n  }\n";
  }
  return text;
}

void emit_rbf(CText& out, const RbfFunction& function) {
  const auto n = static_cast<std::size_t>(function.centre_count());
  const std::string kernel = kernel_facts(function.kernel).c_text;
  Eigen::MatrixXd rows(function.dimension() + 1, function.centre_count());
  rows << function.centres, function.weights.transpose();
  out.add("\n/* ---- correction: radial basis functions; a row: the centre, then its weight ---- */\n\n");
  out.list("tail", function.tail);
  out.table("centres", rows);
  out.add("\nstatic real correction_of(const real *u) {\n" + tail_text(function) + "  for (i = 0; i < " +
          std::to_string(n) +
          "; ++i) {\n    real squared = R(0.0);\n    for (k = 0; k < FEATURES; ++k) {\n"
          "      const real difference = u[k] - centres[i][k];\n      squared += difference * difference;\n    }\n"
          "    squared = larger(squared, R(1e-36));\n    sum += centres[i][FEATURES] * (" +
          kernel + ");\n  }\n  return sum;\n}\n");
}

constexpr const char* kGridC = R"C(
static real correction_of(const real *u) {
  real corner[CORNERS];
  real fraction[FEATURES];
  int base = 0;
  int k, c, half;
  for (k = 0; k < FEATURES; ++k) {
    const real *const axis = axes + axis_begin[k];
    const real at = clamped(u[k], axis[0], axis[axis_size[k] - 1]);
    int cell = 0;
    while (cell + 2 < axis_size[k] && axis[cell + 1] <= at) ++cell;
    base += cell * axis_stride[k];
    fraction[k] = (at - axis[cell]) / (axis[cell + 1] - axis[cell]);
  }
  for (c = 0; c < CORNERS; ++c) {
    int node = base;
    for (k = 0; k < FEATURES; ++k) node += ((c >> k) & 1) * axis_stride[k];
    corner[c] = grid_values[node];
  }
  for (k = FEATURES - 1, half = CORNERS / 2; k >= 0; --k, half /= 2) {
    for (c = 0; c < half; ++c) corner[c] += fraction[k] * (corner[c + half] - corner[c]);
  }
  return corner[0];
}
)C";

void emit_grid(CText& out, const VoxelGrid& grid) {
  const std::size_t d = grid.nodes.size();
  const std::size_t corners = std::size_t{1} << d;
  std::vector<double> nodes;
  std::string sizes;
  std::string begins;
  std::string strides;
  std::size_t stride = grid.values_N.size();
  for (const std::vector<double>& axis : grid.nodes) {
    const std::string comma = sizes.empty() ? "" : ", ";
    stride /= axis.size();
    begins += comma + std::to_string(nodes.size());
    sizes += comma + std::to_string(axis.size());
    strides += comma + std::to_string(stride);
    nodes.insert(nodes.end(), axis.begin(), axis.end());
  }
  out.add("\n/* ---- correction: a grid, the last axis fastest ---- */\n\n#define CORNERS " + std::to_string(corners) +
          "\nstatic const int axis_begin[FEATURES] = {" + begins + "};\nstatic const int axis_size[FEATURES] = {" +
          sizes + "};\nstatic const int axis_stride[FEATURES] = {" + strides + "};\n");
  out.list("axes", nodes);
  out.list("grid_values", grid.values_N);
  out.add(kGridC);
}

constexpr const char* kTrustC = R"C(
static real trust_in(const real *u) {
  float query[FEATURES];
  float smallest = 3.402823466e+38F;
  double squared;
  double t;
  int i, k;
  for (k = 0; k < FEATURES; ++k) {
    if (!(absolute(u[k]) < R(1e19))) return R(0.0);
    query[k] = absolute(u[k]) < R(1e-11) ? 0.0F : (float)u[k];
  }
  for (i = 0; i < COVER_POINTS; ++i) {
    float sum = 0.0F;
    for (k = 0; k < FEATURES; ++k) {
      const float difference = query[k] - cover[i][k];
      ADD_SQUARE(sum, difference);
    }
    if (sum < smallest) smallest = sum;
  }
  squared = (double)smallest;
  if (!(squared < OUTER_RADIUS * OUTER_RADIUS)) return R(0.0);
  if (squared <= INNER_RADIUS * INNER_RADIUS) return R(1.0);
  t = (OUTER_RADIUS - (double)SQRT((real)squared)) / (OUTER_RADIUS - INNER_RADIUS);
  return (real)(t * t * (3.0 - 2.0 * t));
}
)C";

// "static real correction_of(const real *u)": newtons, from normalised features.
void write_correction(CText& out, const CorrectionPtr& correction) {
  if (const RbfFunction* function = rbf_of(correction)) return emit_rbf(out, *function);
  if (const VoxelGrid* grid = grid_of(correction)) return emit_grid(out, *grid);
  if (!correction->is_none()) std::abort();  // a kind without C text: a mistake of the program
  out.add(
      "\n/* no correction: the model is its trend */\n\nstatic real correction_of(const real *u) {\n"
      "  (void)u;\n  return R(0.0);\n}\n");
}

// "static real trust_in(const real *u)": 1 near the data, 0 out of domain.
void write_trust(CText& out, const DomainCover& cover) {
  const auto n = static_cast<std::size_t>(cover.points.cols());
  // Compared in single precision, as in the library, whose instructions add a square with one rounding; a sum in double
  // precision with one rounding to single gives the same.
  out.add("\n/* ---- trust: the distance to the nearest of the data ---- */\n\n#define COVER_POINTS " +
          std::to_string(n) + "\n#define INNER_RADIUS ");
  const CText exact(false);
  out.add(exact.number(cover.inner_radius) + "\n#define OUTER_RADIUS " + exact.number(cover.outer_radius) + "\n");
  out.add(out.single() ? "#define ADD_SQUARE(sum, x) sum += (x) * (x)\n"
                       : "#define ADD_SQUARE(sum, x) sum = (float)((double)(x) * (double)(x) + (double)sum)\n");
  out.table("cover", cover.points.unaryExpr([](double x) { return std::abs(x) < 1e-11 ? 0.0 : x; }), "float");
  out.add(kTrustC);
}

constexpr const char* kTickC = R"C(
static int is_out_of_domain;

static real model_force(void) {
  real u[FEATURES];
  real trust, force_N;
  int k;
  for (k = 0; k < FEATURES; ++k) u[k] = (value[k] - offset[k]) * inverse_scale[k];
  force_N = trend_of();
  trust = trust_in(u);
  is_out_of_domain = trust < R(0.5) || IS_TOO_DEEP;
  if (trust > R(0.0)) {
    const real correction_N = correction_of(u) - CORRECTED_SHARE * force_N;
    force_N += trust * clamped(correction_N, -CORRECTION_LIMIT_N, CORRECTION_LIMIT_N);
  }
  if (!(force_N > R(0.0))) force_N = force_N < R(0.0) ? larger(force_N, LOWEST_FORCE_N) : R(0.0);
  return smaller(force_N, LARGEST_FORCE_N);
}

static real force_of(real step_s, real position_m) {
  const int first = !motion.started;
  const int repeated = !first && position_m == motion.position_m;
  const real motion_step_s = advance_motion(&motion, MOTION_STATES, step_s, position_m);
  if (motion_step_s > R(0.0)) {
    measure_position(&motion, MOTION_STATES, motion_step_s, repeated, R(PALPATE_ENCODER_STEP_M),
                     R(PALPATE_POSITION_NOISE_M));
  }
  update_features(step_s, first);
  is_out_of_domain = 0;
  return position_m > SURFACE_POSITION_M ? model_force() : R(0.0);
}

void palpate_reset(void) {
  static MotionState nothing; /* zero */
  motion = nothing;
  is_out_of_domain = 0;
}

int palpate_out_of_domain(void) { return is_out_of_domain; }

real palpate_force_after(real step_s, real position_m) {
  if (!finite_number(step_s) || !finite_number(position_m) || (motion.started && !(step_s > R(0.0)))) return R(0.0);
  last_time_s += step_s;
  return force_of(step_s, position_m);
}

real palpate_force(real time_s, real position_m) {
  const real step_s = time_s - last_time_s;
  if (!finite_number(time_s) || !finite_number(position_m) || (motion.started && !(step_s > R(0.0)))) return R(0.0);
  last_time_s = time_s;
  return force_of(step_s, position_m);
}
)C";

void write_constants(CText& out, const ModelData& data) {
  out.add("\n/* ---- the force ---- */\n\n#define CORRECTED_SHARE " +
          std::string(data.corrects_trend || data.correction->is_none() ? "R(0.0)" : "R(1.0)") +
          "\n#define CORRECTION_LIMIT_N " + out.number(data.correction_limit_N) + "\n#define LARGEST_FORCE_N " +
          out.number(kForceMargin * data.largest_force_N) + "\n#define LOWEST_FORCE_N " +
          out.number(data.lowest_force_N) + "\n");
  // A press deeper than the recorded ones, as in the library.
  std::size_t depth = 0;
  const double deepest_m = deepest_in_domain_m(data, depth);
  out.add("#define IS_TOO_DEEP " +
          (std::isfinite(deepest_m) ? "(value[" + std::to_string(depth) + "] > " + out.number(deepest_m) + ")" : "0") +
          "\n");
  out.list("offset", data.offset);
  out.list("inverse_scale", Eigen::VectorXd(data.scale.cwiseInverse()));
}

}  // namespace

ExportedC export_c(const ModelData& data, const ExportRequest& request) {
  CText out(request.single_precision);
  out.add(head(data, request));
  out.add(request.single_precision ? kFloatC : kDoubleC);
  out.add("#define R(x) ((real)(x))\n#define MOTION_STATES 3\n#define FEATURES " +
          std::to_string(data.features.size()) + "\n#define SURFACE_POSITION_M " +
          out.number(surface_position_m(data.features)) +
          "\n\nreal palpate_force(real time_s, real position_m);\n"
          "real palpate_force_after(real step_s, real position_m);\n"
          "void palpate_reset(void);\nint palpate_out_of_domain(void);\n");
  out.add(kMotionFilterC);
  out.add(kMotionStateC);
  write_features(out, data.features);
  write_trend(out, data.trend, data.features);
  write_correction(out, data.correction);
  write_trust(out, data.cover);
  write_constants(out, data);
  out.add(kTickC);
  const std::size_t numbers = kMotionNumbers + 3 * data.features.size();
  const std::size_t size = request.single_precision ? sizeof(float) : sizeof(double);
  return {out.text(), out.table_bytes(), numbers * size};
}

}  // namespace palpate
