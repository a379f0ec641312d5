#include "models/export/feature_c.h"

#include <algorithm>
#include <string>

namespace palpate {
namespace {

// Only the file's own text and numbers come into the output; nothing of a name.
// append(): of "[" + a temporary g++ 12 warns.
std::string index_text(std::size_t index) { return std::string("[").append(std::to_string(index)).append("]"); }

constexpr const char* kFeatureHelpersC = R"C(
/* ---- features ---- */

static real value[FEATURES];
static real depth_m;
static real last_depth_m;

/* sum_k coefficient[k] u^(k+1), beyond u = 1 along its tangent. */
static real rising_curve(const real *coefficient, int count, real u) {
  const real inside = smaller(u, R(1.0));
  real sum = R(0.0);
  real slope = R(0.0);
  int k;
  for (k = count - 1; k >= 0; --k) {
    slope = slope * inside + (real)(k + 1) * coefficient[k];
    sum = (sum + coefficient[k]) * inside;
  }
  return u > R(1.0) ? sum + slope * (u - R(1.0)) : sum;
}
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

// Writes the table; returns the curve's value at `depth`, a C expression.
std::string coefficients(CText& out, const std::string& name, const DriveCurve& curve,
                         const std::string& depth = "depth_m") {
  out.list(name, Eigen::Map<const Eigen::VectorXd>(curve.coefficient_N.data(), kDriveCoefficients));
  return "rising_curve(" + name + ", " + std::to_string(kDriveCoefficients) + ", " + depth + " / " +
         out.number(curve.reference_depth_m) + ")";
}

// Of one feature: tables and state go to `out` at once, the returned text goes into
// update_features.
using FeatureEmitter = std::string (*)(CText& out, const FeatureSpec& spec, std::size_t index);

std::string emit_depth(CText&, const FeatureSpec&, std::size_t index) {
  return "  value" + index_text(index) + " = depth_m;\n";
}

std::string emit_velocity(CText&, const FeatureSpec&, std::size_t index) {
  return "  value" + index_text(index) + " = depth_m > R(0.0) ? velocity_estimate_m_per_s : R(0.0);\n";
}

std::string emit_lowpass(CText& out, const FeatureSpec& spec, std::size_t index) {
  out.count({.arithmetic = 8, .divisions = 2, .exponentials = 1});
  const std::string target = "value" + index_text(index);
  return "  " + target + " = first ? R(0.0) : filtered(" + target + ", depth_m - last_depth_m, step_s, " +
         out.number(spec.relaxation_time_s) + ", R(1.0));\n";
}

// A branch behind a drive: state `target`, drive of the last sample in `last`.
std::string emit_branch(CText& out, const std::string& target, const std::string& name, const DriveCurve& drive,
                        double time_s) {
  out.count({.arithmetic = 26, .divisions = 3, .exponentials = 1});
  const std::string curve = coefficients(out, name, drive);
  out.add("static real " + name + "_last;\n");
  const std::string time = out.number(time_s);
  return "  {\n    const real drive = " + curve + ";\n    " + target + " = first ? R(0.0) : filtered(" + target +
         ", drive - " + name + "_last, step_s, " + time + ", " + time + ");\n    " + name + "_last = drive;\n  }\n";
}

std::string emit_maxwell(CText& out, const FeatureSpec& spec, std::size_t index) {
  return emit_branch(out, "value" + index_text(index), "drive_" + std::to_string(index), spec.drive,
                     spec.relaxation_time_s);
}

// Of every part of a spectrum a branch, summed.
std::string emit_spectrum(CText& out, const FeatureSpec& spec, std::size_t index) {
  const std::string state = "part_" + std::to_string(index);
  out.add("static real " + state + index_text(spec.part_count) + ";\n");
  std::string text;
  std::string sum;
  for (std::size_t p = 0; p < spec.part_count; ++p) {
    const std::string part = state + index_text(p);
    text += emit_branch(out, part, "drive_" + std::to_string(index) + "_" + std::to_string(p), spec.parts[p].drive,
                        spec.parts[p].relaxation_time_s);
    sum += (p == 0 ? "" : " + ") + part;
  }
  return text + "  value" + index_text(index) + " = " + sum + ";\n";
}

// Stop operators: bristles that bend by at most their threshold and then slip.
std::string emit_stops(CText& out, const FeatureSpec& spec, std::size_t index) {
  const std::string state = "part_" + std::to_string(index);
  out.add("static real " + state + index_text(spec.part_count) + ";\n");
  const std::string target = "value" + index_text(index);
  std::string text = "  " + target + " = R(0.0);\n";
  for (std::size_t p = 0; p < spec.part_count; ++p) {
    out.count({.arithmetic = 27, .divisions = 2});
    const std::string part = state + index_text(p);
    const std::string threshold = out.number(spec.parts[p].threshold_m);
    const std::string curve =
        coefficients(out, "stop_" + std::to_string(index) + "_" + std::to_string(p), spec.parts[p].drive);
    text += "  " + part + " = first || !(depth_m > R(0.0)) ? R(0.0) : clamped(" + part +
            " + depth_m - last_depth_m, -" + threshold + ", " + threshold + ");\n";
    text += "  " + target + " += " + curve + " * " + part + " / " + threshold + ";\n";
  }
  return text;
}

std::string emit_fading_peak(CText& out, const FeatureSpec& spec, std::size_t index) {
  out.count({.arithmetic = 6, .divisions = 1, .exponentials = 1});
  const std::string target = "value" + index_text(index);
  return "  if (first) {\n    " + target + " = depth_m;\n  } else {\n    " + target +
         " = larger(depth_m, last_depth_m + (" + target + " - last_depth_m) * EXP(-step_s / " +
         out.number(spec.relaxation_time_s) + "));\n    if (" + target + " < R(1e-15)) " + target +
         " = R(0.0);\n  }\n";
}

struct FeatureRow {
  FeatureKind kind;
  FeatureEmitter emit;
};
// The table of kinds that can be exported: one line each.
constexpr FeatureRow kFeatureRows[] = {
    {FeatureKind::depth, emit_depth},
    {FeatureKind::velocity, emit_velocity},
    {FeatureKind::lowpass_velocity, emit_lowpass},
    {FeatureKind::maxwell_branch, emit_maxwell},
    {FeatureKind::maxwell_spectrum, emit_spectrum},
    {FeatureKind::stops, emit_stops},
    {FeatureKind::fading_peak, emit_fading_peak},
};

FeatureEmitter emitter_of(FeatureKind kind) {
  for (const FeatureRow& row : kFeatureRows) {
    if (row.kind == kind) return row.emit;
  }
  return nullptr;
}

Error no_emitter(const FeatureSpec& spec) {
  std::string known;
  for (const FeatureRow& row : kFeatureRows) {
    known += (known.empty() ? "" : ", ") + std::string(feature_kind_name(row.kind));
  }
  return {"feature of kind " + std::string(feature_kind_name(spec.kind)) + " cannot be exported, expected " + known +
          "; fit with --features and these kinds"};
}

// The last feature of that kind, as C text; 0 when there is none.
std::string feature_of(const std::vector<FeatureSpec>& features, FeatureKind kind) {
  std::string text = "R(0.0)";
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (features[i].kind == kind) text = "value" + index_text(i);
  }
  return text;
}

bool has_filter(FeatureKind kind) {
  return kind == FeatureKind::lowpass_velocity || kind == FeatureKind::maxwell_branch ||
         kind == FeatureKind::maxwell_spectrum;
}

// Features whose value is a force by itself.
bool is_force(FeatureKind kind) {
  return kind == FeatureKind::maxwell_branch || kind == FeatureKind::maxwell_spectrum || kind == FeatureKind::stops;
}

bool has_peak(const std::vector<FeatureSpec>& features) {
  return std::any_of(features.begin(), features.end(),
                     [](const FeatureSpec& spec) { return spec.kind == FeatureKind::fading_peak; });
}

// What softening adds to the trend, as lines of trend_of; tables go to `out`.
std::string softening_text(CText& out, const Trend& trend, const std::vector<FeatureSpec>& features) {
  static_assert(kSofteningPowers[0] == 1 && kSofteningPowers[1] == 4 && kSofteningPowers[2] == 12 &&
                kSofteningPowers.size() == 3);
  constexpr const char* kShare[] = {"x", "x4", "x4 * x4 * x4"};
  const std::string depth = feature_of(features, FeatureKind::depth);
  const std::string peak = feature_of(features, FeatureKind::fading_peak);
  std::string text = "  {\n    const real x = " + depth + " < " + peak + " ? " + depth + " / " + peak +
                     " : R(1.0);\n    const real x4 = x * x * x * x;\n";
  for (std::size_t j = 0; j < kSofteningPowers.size(); ++j) {
    out.count({.arithmetic = 25, .divisions = 1});
    const std::string curve = coefficients(out, "softening_" + std::to_string(j), trend.softening[j], depth);
    text += "    force_N += " + curve + " * (" + kShare[j] + ");\n";
  }
  return text + "  }\n";
}

}  // namespace

Status write_features(CText& out, const std::vector<FeatureSpec>& features) {
  out.add(kFeatureHelpersC);
  if (std::any_of(features.begin(), features.end(), [](const FeatureSpec& spec) { return has_filter(spec.kind); })) {
    out.add(kFilterC);
  }
  std::string body;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const FeatureEmitter emit = emitter_of(features[i].kind);
    if (emit == nullptr) return no_emitter(features[i]);
    out.add("\n/* " + feature_name(features[i]) + " */\n");
    body += emit(out, features[i], i);
  }
  out.add(
      "\n/* `first`: nothing came before, and every filter is at rest. */\n"
      "static void update_features(real step_s, int first) {\n  (void)step_s;\n  (void)first;\n"
      "  depth_m = larger(R(0.0), position_estimate_m);\n" +
      body + "  last_depth_m = depth_m;\n}\n");
  return {};
}

void write_trend(CText& out, const Trend& trend, const std::vector<FeatureSpec>& features) {
  out.add("\n/* ---- trend: a nonlinear viscoelastic solid ---- */\n\n");
  const auto coefficients_of = [&](const char* name, const auto& values) {
    out.list(name, Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  coefficients_of("elastic", trend.elastic_N);
  coefficients_of("viscosity", trend.viscosity_Ns_per_m);
  coefficients_of("thinning", trend.thinning_Ns_per_m);
  const std::string limit = out.number(trend.velocity_limit_m_per_s);
  const std::string softening = has_peak(features) ? softening_text(out, trend, features) : "";
  std::string text =
      "\nstatic real quadratic(const real *c, real u) { return (c[2] * u + c[1]) * u + c[0]; }\n\n"
      "static real trend_of(void) {\n  const real u = " +
      feature_of(features, FeatureKind::depth) + " / " + out.number(trend.reference_depth_m) +
      ";\n  const real inside = smaller(u, R(1.0));\n  const real v = clamped(" +
      feature_of(features, FeatureKind::velocity) + ", -" + limit + ", " + limit +
      ");\n  const real thinned = v / (R(1.0) + absolute(v) / " + out.number(trend.thinning_velocity_m_per_s) +
      ");\n  real force_N = rising_curve(elastic, " + std::to_string(kElasticCoefficients) +
      ", u);\n  force_N += quadratic(viscosity, inside) * v + quadratic(thinning, inside) * thinned;\n";
  static_assert(kViscosityCoefficients == 3, "quadratic() has three");
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (is_force(features[i].kind)) text += "  force_N += value" + index_text(i) + ";\n";
  }
  out.count({.arithmetic = 46, .divisions = 3});
  out.add(text + softening + "  return force_N;\n}\n");
}

}  // namespace palpate
