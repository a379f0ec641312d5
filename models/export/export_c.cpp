#include "models/export/export_c.h"

#include <cmath>

#include "models/export/correction_c.h"
#include "models/export/feature_c.h"
#include "models/export/motion_filter_c.h"

namespace palpate {
namespace {

// The size of the state of the motion filter, the depth and the last sample, in numbers.
constexpr std::size_t kMotionNumbers = 2 * (3 + 9 + 1) + 2 + 6;

// Replaces characters that are not safe in a C comment.
std::string in_comment(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    const bool plain = c >= ' ' && c <= '~' && c != '*' && c != '?' && c != '\\';
    safe += plain ? c : '_';
  }
  return safe;
}

// Describes the sensor that the file assumes.
std::string sensor_text(const CText& exact, const PositionSensor& sensor) {
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

// The C condition for a press deeper than the recorded ones, as in the library.
std::string too_deep(const CText& out, const ModelData& data) {
  std::size_t feature = 0;
  const double deepest_m = deepest_in_domain_m(data, feature);
  if (!std::isfinite(deepest_m)) return "0";
  return std::string("(value[")
      .append(std::to_string(feature))
      .append("] > ")
      .append(out.number(deepest_m))
      .append(")");
}

void write_constants(CText& out, const ModelData& data) {
  out.add("\n/* ---- the force ---- */\n\n#define CORRECTED_SHARE " +
          std::string(data.corrects_trend || data.correction->is_none() ? "R(0.0)" : "R(1.0)") +
          "\n#define CORRECTION_LIMIT_N " + out.number(data.correction_limit_N) + "\n#define LARGEST_FORCE_N " +
          out.number(kForceMargin * data.largest_force_N) + "\n#define LOWEST_FORCE_N " +
          out.number(data.lowest_force_N) + "\n");
  out.add("#define IS_TOO_DEEP " + too_deep(out, data) + "\n");
  out.list("offset", data.offset);
  out.list("inverse_scale", data.scale.cwiseInverse());
}

}  // namespace

Result<ExportedC> export_c(const ModelData& data, const ExportRequest& request) {
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
  if (Status status = write_correction(out, data.correction); !status) return status.error();
  write_trust(out, data.cover);
  write_constants(out, data);
  out.add(kTickC);
  const std::size_t numbers = kMotionNumbers + 3 * data.features.size();
  const std::size_t size = request.single_precision ? sizeof(float) : sizeof(double);
  return ExportedC{out.text(), out.table_bytes(), numbers * size};
}

}  // namespace palpate
