#include "models/export/feature_c.h"

#include <algorithm>
#include <iterator>
#include <string>

namespace palpate {
namespace {

// Only text of this file and numbers are written; names from the model file are not.
// append(), because g++ 12 warns about "[" + a temporary.
std::string index_text(std::size_t index) { return std::string("[").append(std::to_string(index)).append("]"); }

constexpr const char* kCurveC = R"C(
/* sum_k coefficient[k] u^(k+1) + sum_k knot[k] max(0, u - (k + 1) / (knots + 1))^3, beyond
   u = 1 along its tangent. */
static real rising_curve(const real *coefficient, int count, const real *knot, int knots, real u) {
  const real inside = smaller(u, R(1.0));
  real sum = R(0.0);
  real slope = R(0.0);
  int k;
  for (k = count - 1; k >= 0; --k) {
    slope = slope * inside + (real)(k + 1) * coefficient[k];
    sum = (sum + coefficient[k]) * inside;
  }
  for (k = 0; k < knots; ++k) {
    const real beyond = larger(R(0.0), inside - (real)(k + 1) / (real)(knots + 1));
    sum += knot[k] * beyond * beyond * beyond;
    slope += R(3.0) * knot[k] * beyond * beyond;
  }
  return u > R(1.0) ? sum + slope * (u - R(1.0)) : sum;
}
)C";

constexpr const char* kFeatureHelpersC = R"C(
/* ---- features ---- */

static real value[FEATURES];
static real depth_m;
static real last_depth_m;
static real surface_m;
)C";

constexpr const char* kSurfaceC = R"C(
/* The surface of the material: under the tool, or where it has come back to. */
static real surface_above(real step_s) {
  real low_N = held(step_s, depth_m);
  real low_m = depth_m;
  real high_m = surface_m;
  real middle_m = surface_m;
  real high_N;
  int k;
  if (low_N >= R(0.0) || !(high_m - low_m > R(1e-12))) return depth_m;
  high_N = held(step_s, high_m);
  if (!(high_N > R(0.0))) return high_m;
  for (k = 0; k < 40; ++k) {
    real middle_N;
    middle_m = low_m - low_N * (high_m - low_m) / (high_N - low_N);
    middle_N = held(step_s, middle_m);
    if (absolute(middle_N) < (sizeof(real) == sizeof(double) ? R(1e-11) : R(1e-5))) break;
    if (middle_N > R(0.0)) {
      high_m = middle_m;
      high_N = middle_N;
      low_N *= R(0.5);
    } else {
      low_m = middle_m;
      low_N = middle_N;
      high_N *= R(0.5);
    }
  }
  return middle_m;
}
)C";

constexpr const char* kCreepC = R"C(
/* What half a step of creep leaves of a bend. */
static real crept(real bend, real creep) { return bend / SQRT(R(1.0) + creep * bend * bend); }
)C";

constexpr const char* kFilterC = R"C(
/* 1 - exp(-x) for x >= 0, without cancellation in single precision. */
static real lost_share(real x) {
  if (sizeof(real) == sizeof(double) || x > R(0.1)) return R(1.0) - EXP(-x);
  return x * (R(1.0) - x / R(2.0) * (R(1.0) - x / R(3.0) * (R(1.0) - x / R(4.0) * (R(1.0) - x / R(5.0)))));
}

/* A first-order filter behind what moved by `change` in `step_s`. */
static real filtered(real state, real change, real step_s, real time_s, real gain) {
  const real lost = lost_share(step_s / time_s);
  const real next = (R(1.0) - lost) * state + gain * lost * change / step_s;
  return absolute(next) < R(1e-30) ? R(0.0) : next;
}
)C";

// Writes the tables of a curve; returns the C expression of its value at `depth`.
std::string write_drive(CText& out, const std::string& name, const DriveCurve& curve, const std::string& depth) {
  out.list(name, curve.coefficient_N);
  if (curve.has_knots) out.list(name + "_knot", curve.knot_N);
  return "rising_curve(" + name + ", " + std::to_string(kDriveCoefficients) + ", " +
         (curve.has_knots ? name + "_knot, " + std::to_string(kDriveKnots) : "0, 0") + ", " + depth + " / " +
         out.number(curve.reference_depth_m) + ")";
}

// Emits one feature: writes its tables and state to `out`, and returns its statements in update_features.
using FeatureEmitter = std::string (*)(CText& out, const FeatureSpec& spec, std::size_t index);

std::string emit_depth(CText&, const FeatureSpec&, std::size_t index) {
  return "  value" + index_text(index) + " = depth_m;\n";
}

std::string emit_velocity(CText&, const FeatureSpec&, std::size_t index) {
  return "  value" + index_text(index) + " = depth_m > R(0.0) ? motion.velocity_m_per_s : R(0.0);\n";
}

std::string emit_lowpass(CText& out, const FeatureSpec& spec, std::size_t index) {
  const std::string target = "value" + index_text(index);
  return "  " + target + " = first ? R(0.0) : filtered(" + target + ", depth_m - last_depth_m, step_s, " +
         out.number(spec.relaxation_time_s) + ", R(1.0));\n";
}

// As surface_halfway() of engine/tick/features.h.
constexpr const char* kSurfaceHalfwayC =
    "(surface_m > last_depth_m && surface_m > depth_m ? surface_m : R(0.5) * (surface_m + depth_m))";

// Emits a branch with its drive. The state is `target`; functions prefixed by `name` give the drive and the next state.
std::string emit_branch(CText& out, const std::string& target, const std::string& name, const DriveCurve& drive,
                        double time_s, double slowing) {
  const std::string curve = write_drive(out, name, drive, "s");
  const std::string clock = slowing == 0.0 ? ""
                                           : "EXP(" + out.number(slowing) + " * smaller(R(1.0), " + kSurfaceHalfwayC +
                                                 " / " + out.number(drive.reference_depth_m) + ")) * ";
  out.add("static real " + name + "_last;\nstatic real " + name + "_drive(real s) { return " + curve +
          "; }\nstatic real " + name + "_after(real step_s, real s) {\n  const real time_s = " + clock +
          out.number(time_s) + ";\n  return filtered(" + target + ", " + name + "_drive(s) - " + name +
          "_last, step_s, time_s, time_s);\n}\n");
  return "  " + target + " = first ? R(0.0) : " + name + "_after(step_s, s);\n  " + name + "_last = " + name +
         "_drive(s);\n";
}

std::string branch_name(std::size_t index, std::size_t part) {
  return "drive_" + std::to_string(index) + "_" + std::to_string(part);
}

// Writes the force that determines the surface: all branches and the elastic response of the lag.
void write_surface(CText& out, const std::vector<FeatureSpec>& features, const FeatureSpec& lag) {
  const std::string elastic = write_drive(out, "surface_elastic", lag.drive, "s");
  std::string text = "\nstatic real held(real step_s, real s) {\n  return " + elastic;
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (std::size_t p = 0; features[i].kind == FeatureKind::maxwell_spectrum && p < features[i].part_count; ++p) {
      text += " + " + branch_name(i, p) + "_after(step_s, s)";
    }
  }
  out.add(text + ";\n}\n" + kSurfaceC);
}

std::string emit_surface_lag(CText&, const FeatureSpec&, std::size_t index) {
  return "  value" + index_text(index) + " = s - depth_m;\n";
}

// Emits a branch for every part of a spectrum, and their sum.
std::string emit_spectrum(CText& out, const FeatureSpec& spec, std::size_t index) {
  const std::string state = "part_" + std::to_string(index);
  out.add("static real " + state + index_text(spec.part_count) + ";\n");
  std::string text;
  std::string sum;
  for (std::size_t p = 0; p < spec.part_count; ++p) {
    const std::string part = state + index_text(p);
    text += emit_branch(out, part, branch_name(index, p), spec.parts[p].drive, spec.parts[p].relaxation_time_s,
                        spec.slowing);
    sum += (p == 0 ? "" : " + ") + part;
  }
  return text + "  value" + index_text(index) + " = " + sum + ";\n";
}

// Emits bristles: a stop bends by at most its threshold and then slips; the others creep at any bend.
std::string emit_bristles(CText& out, const FeatureSpec& spec, std::size_t index) {
  const std::string state = "part_" + std::to_string(index);
  out.add("static real " + state + index_text(spec.part_count) + ";\n");
  const std::string target = "value" + index_text(index);
  std::string text = "  " + target + " = R(0.0);\n";
  for (std::size_t p = 0; p < spec.part_count; ++p) {
    const std::string part = state + index_text(p);
    const std::string threshold = out.number(spec.parts[p].threshold_m);
    const std::string curve =
        write_drive(out, "bristle_" + std::to_string(index) + "_" + std::to_string(p), spec.parts[p].drive, "depth_m");
    if (spec.kind == FeatureKind::stops) {
      text += "  " + part + " = first || !(depth_m > R(0.0)) ? R(0.0) : clamped(" + part +
              " + depth_m - last_depth_m, -" + threshold + ", " + threshold + ");\n";
    } else {
      const double r_m = spec.parts[p].threshold_m;
      const std::string creep = "step_s * " + out.number(1.0 / (spec.parts[p].relaxation_time_s * r_m * r_m));
      text += "  " + part + " = first ? R(0.0) : crept(crept(" + part + ", " + creep + ") + depth_m - last_depth_m, " +
              creep + ");\n";
    }
    text += "  " + target + " += " + curve + " * " + part + " / " + threshold + ";\n";
  }
  return text;
}

// In the order of the kinds.
constexpr FeatureEmitter kEmitters[] = {emit_depth,    emit_velocity, emit_lowpass,    emit_spectrum,
                                        emit_bristles, emit_bristles, emit_surface_lag};
static_assert(std::size(kEmitters) == kFeatureKinds.size());

bool has_filter(FeatureKind kind) { return kind == FeatureKind::lowpass_velocity || is_branch(kind); }

}  // namespace

void write_features(CText& out, const std::vector<FeatureSpec>& features) {
  out.add(kFeatureHelpersC);
  const auto any = [&](bool (*has)(FeatureKind)) {
    return std::any_of(features.begin(), features.end(), [&](const FeatureSpec& spec) { return has(spec.kind); });
  };
  if (any([](FeatureKind kind) { return has_drive(kind) || has_parts(kind); })) out.add(kCurveC);
  if (any(has_filter)) out.add(kFilterC);
  if (any([](FeatureKind kind) { return kind == FeatureKind::creep; })) out.add(kCreepC);
  std::string body;
  for (std::size_t i = 0; i < features.size(); ++i) {
    out.add("\n/* " + feature_name(features[i]) + " */\n");
    body += kEmitters[static_cast<std::size_t>(features[i].kind)](out, features[i], i);
  }
  const auto lag = std::find_if(features.begin(), features.end(),
                                [](const FeatureSpec& spec) { return spec.kind == FeatureKind::surface_lag; });
  const bool lags = lag != features.end();
  if (lags) write_surface(out, features, *lag);
  out.add(
      "\n/* `first`: nothing came before, and every filter is at rest. */\n"
      "static void update_features(real step_s, int first) {\n  (void)step_s;\n  (void)first;\n"
      "  real s;\n  depth_m = larger(R(0.0), motion.estimate_m - SURFACE_POSITION_M);\n  s = " +
      std::string(lags ? "first ? depth_m : surface_above(step_s)" : "depth_m") + ";\n  (void)s;\n" + body +
      "  last_depth_m = depth_m;\n  surface_m = s;\n}\n");
}

void write_trend(CText& out, const Trend& trend, const std::vector<FeatureSpec>& features) {
  out.add("\n/* ---- trend: a nonlinear viscoelastic solid ---- */\n\n");
  out.list("elastic", trend.elastic.pieces_N);
  const std::string pieces = out.number(static_cast<double>(kElasticPieces));
  out.list("viscosity", trend.viscosity_Ns_per_m);
  out.list("thinning", trend.thinning_Ns_per_m);
  const std::string limit = out.number(trend.velocity_limit_m_per_s);
  const TrendInputs inputs(features);
  const auto input = [](std::uint8_t index) {
    return index == TrendInputs::kNone ? "R(0.0)" : "value" + index_text(index);
  };
  std::string text =
      "\n/* A cubic on each of equal pieces, beyond u = 1 along its tangent. */\n"
      "static real elastic_at(real u) {\n  const real x = u * " +
      pieces + ";\n  const int piece = x < " + pieces +
      " ? (int)larger(R(0.0), x) : " + std::to_string(kElasticPieces - 1) +
      ";\n  const real beyond = larger(R(0.0), x - " + pieces +
      ");\n  const real t = x - (real)piece - beyond;\n  const real *c = elastic + 4 * piece;\n"
      "  return c[0] + t * (c[1] + t * (c[2] + t * c[3])) + beyond * (c[1] + t * (R(2.0) * c[2] + t * R(3.0) * c[3]));"
      "\n}\n\n"
      "static real quadratic(const real *c, real u) { return (c[2] * u + c[1]) * u + c[0]; }\n\n"
      "static real trend_of(void) {\n  const real u = " +
      input(inputs.depth) + " / " + out.number(trend.reference_depth_m) +
      ";\n  const real inside = smaller(u, R(1.0));\n  const real v = clamped(" + input(inputs.velocity) + ", -" +
      limit + ", " + limit + ");\n  const real thinned = v / (R(1.0) + absolute(v) / " +
      out.number(trend.thinning_velocity_m_per_s) +
      ");\n  real force_N = elastic_at(u);\n  force_N += quadratic(viscosity, inside) * v + quadratic(thinning, "
      "inside) * thinned;\n";
  static_assert(kViscosityCoefficients == 3, "quadratic() has three");
  for (std::size_t i = 0; i < inputs.force_count; ++i) text += "  force_N += " + input(inputs.force[i]) + ";\n";
  out.add(text + "  return force_N;\n}\n");
}

}  // namespace palpate
