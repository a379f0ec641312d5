#include "models/export/export_c.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/base/text.h"
#include "models/export/feature_c.h"
#include "models/export/motion_filter_c.h"
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

constexpr const char* kHeadC = R"C( *
 * C99; needs sqrt and exp, and log for a thin-plate kernel. `real` is double or float.
 *
 * real palpate_force(real time_s, real position_m): the force in N, positive out of the
 *   material. position_m: as in the recordings, whose undisturbed surface is at
 *   SURFACE_POSITION_M, positive inside. If a value is not finite or the time is not later than
 *   the last one: 0 N, and the state is kept.
 * real palpate_force_after(real step_s, real position_m): the same, `step_s` after the last
 *   call; better in single precision, where a large time has coarse steps.
 * int palpate_out_of_domain(void): 1 if the last motion was outside the recorded domain.
 * void palpate_reset(void): the next sample begins a new contact.
 *
 * One tool, one thread: the state is static. For two models in one program compile one
 * with -Dpalpate_force=other_force and so on.
 * For another sensor than that of the next two macros define them when compiling: the step of
 * the positions (0 if there is none) and the standard deviation of the additional noise. A
 * recording of such positions, without measured velocity or acceleration, gives the forces of
 * palpate replay.
 */

)C";

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

constexpr const char* kPrototypesC = R"C(#define R(x) ((real)(x))

real palpate_force(real time_s, real position_m);
real palpate_force_after(real step_s, real position_m);
void palpate_reset(void);
int palpate_out_of_domain(void);
)C";

constexpr const char* kMotionStateC = R"C(
static MotionState motion;
static real last_time_s;

static real clamped(real x, real low, real high) { return x < low ? low : (high < x ? high : x); }
static real absolute(real x) { return x < R(0.0) ? -x : x; }
static int finite_number(real x) { return x - x == R(0.0); }
)C";

constexpr const char* kRbfC = R"C(
static real correction_of(const real *u) {
  const real *term = tail;
  real sum = *term++;
  int i, k;
  for (k = 0; TAIL_DEGREE >= 1 && k < FEATURES; ++k) sum += *term++ * u[k];
  for (i = 0; i < CENTRES; ++i) {
    real squared = R(0.0);
    for (k = 0; k < FEATURES; ++k) {
      const real difference = u[k] - centres[i][k];
      squared += difference * difference;
    }
    squared = larger(squared, R(1e-36));
    sum += centres[i][FEATURES] * (KERNEL);
  }
  return sum;
}
)C";

void write_rbf(CText& out, const RbfFunction& function) {
  Eigen::MatrixXd rows(function.dimension() + 1, function.centre_count());
  rows << function.centres, function.weights.transpose();
  out.add("\n/* ---- correction: radial basis functions; a row: the centre, then its weight ---- */\n\n");
  out.define("CENTRES", static_cast<std::size_t>(function.centre_count()));
  out.define("TAIL_DEGREE", static_cast<std::size_t>(tail_degree(function.kernel)));
  out.define("KERNEL", kernel_facts(function.kernel).c_text);
  out.list("tail", function.tail);
  out.table("centres[][FEATURES + 1]", rows);
  out.add(kRbfC);
}

constexpr const char* kGridC = R"C(
static real correction_of(const real *u) {
  real corner[CORNERS];
  real fraction[FEATURES];
  int cell[FEATURES];
  const real *axis = axes;
  int k, c, half;
  for (k = 0; k < FEATURES; ++k) {
    const real at = clamped(u[k], axis[0], axis[axis_size[k] - 1]);
    int i = 0;
    while (i + 2 < axis_size[k] && axis[i + 1] <= at) ++i;
    cell[k] = i;
    fraction[k] = (at - axis[i]) / (axis[i + 1] - axis[i]);
    axis += axis_size[k];
  }
  for (c = 0; c < CORNERS; ++c) {
    int node = 0;
    for (k = 0; k < FEATURES; ++k) node = node * axis_size[k] + cell[k] + ((c >> k) & 1);
    corner[c] = grid_values[node];
  }
  for (k = FEATURES - 1, half = CORNERS / 2; k >= 0; --k, half /= 2) {
    for (c = 0; c < half; ++c) corner[c] += fraction[k] * (corner[c + half] - corner[c]);
  }
  return corner[0];
}
)C";

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
  is_out_of_domain = trust < R(0.5) || value[DEPTH_FEATURE] > DEEPEST_M;
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

static int accepted(real step_s, real position_m) {
  return finite_number(step_s) && finite_number(position_m) && (!motion.started || step_s > R(0.0));
}

real palpate_force_after(real step_s, real position_m) {
  if (!accepted(step_s, position_m)) return R(0.0);
  last_time_s += step_s;
  return force_of(step_s, position_m);
}

real palpate_force(real time_s, real position_m) {
  const real step_s = time_s - last_time_s;
  if (!accepted(step_s, position_m)) return R(0.0);
  last_time_s = time_s;
  return force_of(step_s, position_m);
}
)C";

void write_constants(CText& out, const ModelData& data) {
  out.add("\n/* ---- the force ---- */\n\n");
  out.define("CORRECTED_SHARE", data.corrects_trend || !data.correction ? 0.0 : 1.0);
  out.define("CORRECTION_LIMIT_N", data.correction_limit_N);
  out.define("LARGEST_FORCE_N", kForceMargin * data.largest_force_N);
  out.define("LOWEST_FORCE_N", data.lowest_force_N);
  // A press deeper than the recorded ones, as in the library. Infinity has no literal in C.
  std::size_t depth = 0;
  const double deepest_m = std::min(deepest_in_domain_m(data, depth), 1e30);
  out.define("DEPTH_FEATURE", depth);
  out.define("DEEPEST_M", deepest_m);
  out.list("offset", data.offset);
  out.list("inverse_scale", Eigen::VectorXd(data.scale.cwiseInverse()));
}

}  // namespace

std::string export_c(const ModelData& data, const SensorSpec& sensor, bool single_precision) {
  CText out(single_precision);
  out.add("/* Force model " + in_comment(data.name) + ", written by palpate export.\n * Features:");
  for (const FeatureSpec& spec : data.features) out.add(std::string(" ").append(feature_name(spec)));
  out.add("\n");
  out.add(kHeadC);
  out.add("#ifndef PALPATE_ENCODER_STEP_M\n");
  out.define("PALPATE_ENCODER_STEP_M", sensor.encoder_step_m);
  out.add("#endif\n#ifndef PALPATE_POSITION_NOISE_M\n");
  out.define("PALPATE_POSITION_NOISE_M", sensor.position_noise_m);
  out.add("#endif\n\n");
  out.add(single_precision ? kFloatC : kDoubleC);
  out.define("MOTION_STATES", std::size_t{3});
  out.define("FEATURES", data.features.size());
  out.define("SURFACE_POSITION_M", surface_position_m(data.features));
  out.add(kPrototypesC);
  out.add(kMotionFilterC);
  out.add(kMotionStateC);
  write_features(out, data.features);
  write_trend(out, data.trend, data.features);
  write_correction(out, data.correction);
  write_trust(out, data.cover);
  write_constants(out, data);
  out.add(kTickC);
  return out.text();
}

}  // namespace palpate
