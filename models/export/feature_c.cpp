#include "models/export/feature_c.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <tuple>

namespace palpate {
namespace {

constexpr const char* kFeatureStateC = R"C(
/* ---- features ---- */

static real value[FEATURES];
static real depth_m;
static real last_depth_m;
static real surface_m;
)C";

// A row of a table of parts: two numbers, then its drive: the reference depth, the coefficients, the knots.
constexpr const char* kCurveC = R"C(
/* sum_k coefficient[k] u^(k+1) + sum_k knot[k] max(0, u - (k + 1) / (knots + 1))^3 with
   u = depth / reference depth, beyond u = 1 along its tangent. */
static real rising_curve(const real *part, real at_m) {
  const real *const row = part + 2;
  const real u = at_m / row[0];
  const real inside = smaller(u, R(1.0));
  real sum = R(0.0);
  real slope = R(0.0);
  int k;
  for (k = DRIVE_COEFFICIENTS; k > 0; --k) {
    slope = slope * inside + (real)k * row[k];
    sum = (sum + row[k]) * inside;
  }
  for (k = 1; k <= DRIVE_KNOTS; ++k) {
    const real knot = row[DRIVE_COEFFICIENTS + k];
    const real beyond = larger(R(0.0), inside - (real)k / (real)(DRIVE_KNOTS + 1));
    sum += knot * beyond * beyond * beyond;
    slope += R(3.0) * knot * beyond * beyond;
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

constexpr const char* kBranchC = R"C(
/* The branches of all relaxation spectra, and their drives at the last surface. A part: its time in s, its slowing. */
static real branch[BRANCHES];
static real branch_last[BRANCHES];

static real branch_after(int k, real step_s, real s) {
  const int left = surface_m > last_depth_m && surface_m > depth_m;
  const real halfway_m = left ? surface_m : R(0.5) * (surface_m + depth_m);
  const real *const part = branch_part[k];
  real time_s = part[0];
  if (part[1] != R(0.0)) time_s *= EXP(part[1] * smaller(R(1.0), halfway_m / part[2]));
  return filtered(branch[k], rising_curve(part, s) - branch_last[k], step_s, time_s, time_s);
}

static real branches(int begin, int end, real step_s, int first, real s) {
  real sum = R(0.0);
  int k;
  for (k = begin; k < end; ++k) {
    branch[k] = first ? R(0.0) : branch_after(k, step_s, s);
    branch_last[k] = rising_curve(branch_part[k], s);
    sum += branch[k];
  }
  return sum;
}
)C";

// The force that determines the surface: all branches and the elastic response of the lag.
constexpr const char* kSurfaceC = R"C(
static real held(real step_s, real s) {
  real sum = rising_curve(surface_elastic[0], s);
  int k;
  for (k = 0; k < BRANCHES; ++k) sum += branch_after(k, step_s, s);
  return sum;
}

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

constexpr const char* kBristleC = R"C(
/* A part: its threshold in m, its creep per m^2 and s. */
static real bristle[BRISTLES];

/* What half a step of creep leaves of a bend. */
static real crept(real bend, real creep) { return bend / SQRT(R(1.0) + creep * bend * bend); }

/* A stop, whose creep is 0, bends by at most its threshold and then slips; the others creep at any bend. */
static real bristles(int begin, int end, real step_s, int first) {
  real sum = R(0.0);
  int k;
  for (k = begin; k < end; ++k) {
    const real threshold_m = bristle_part[k][0];
    const real creep = step_s * bristle_part[k][1];
    const int stops = !(bristle_part[k][1] > R(0.0));
    if (first || (stops && !(depth_m > R(0.0)))) {
      bristle[k] = R(0.0);
    } else if (stops) {
      bristle[k] = clamped(bristle[k] + depth_m - last_depth_m, -threshold_m, threshold_m);
    } else {
      bristle[k] = crept(crept(bristle[k], creep) + depth_m - last_depth_m, creep);
    }
    sum += rising_curve(bristle_part[k], depth_m) * bristle[k] / threshold_m;
  }
  return sum;
}
)C";

constexpr const char* kTrendC = R"C(
/* A cubic on each of equal pieces, beyond u = 1 along its tangent. */
static real elastic_at(real u) {
  const real x = u * R(ELASTIC_PIECES);
  const int piece = x < R(ELASTIC_PIECES) ? (int)larger(R(0.0), x) : ELASTIC_PIECES - 1;
  const real beyond = larger(R(0.0), x - R(ELASTIC_PIECES));
  const real t = x - (real)piece - beyond;
  const real *c = elastic + 4 * piece;
  return c[0] + t * (c[1] + t * (c[2] + t * c[3])) + beyond * (c[1] + t * (R(2.0) * c[2] + t * R(3.0) * c[3]));
}

static real quadratic(const real *c, real u) { return (c[2] * u + c[1]) * u + c[0]; }

static real trend_of(void) {
  const real u = TREND_DEPTH / REFERENCE_DEPTH_M;
  const real inside = smaller(u, R(1.0));
  const real v = clamped(TREND_VELOCITY, -VELOCITY_LIMIT_M_PER_S, VELOCITY_LIMIT_M_PER_S);
  const real thinned = v / (R(1.0) + absolute(v) / THINNING_VELOCITY_M_PER_S);
  real force_N = elastic_at(u);
  force_N += quadratic(viscosity, inside) * v + quadratic(thinning, inside) * thinned;
  ADD_FEATURE_FORCES
  return force_N;
}
)C";

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
      return "depth_m";
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

// Only text of this file and numbers are written; names from the model file are not.
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
  out.add(kFeatureStateC);
  out.define("DRIVE_COEFFICIENTS", kDriveCoefficients);
  out.define("DRIVE_KNOTS", kDriveKnots);
  out.define("BRANCHES", branches.size());
  out.define("BRISTLES", bristles.size());
  if (!branches.empty() || !bristles.empty()) out.add(kCurveC);
  if (!branches.empty() || body.find("filtered(") != std::string::npos) out.add(kFilterC);
  if (!branches.empty()) write_parts(out, "branch_part", branches);
  if (!branches.empty()) out.add(kBranchC);
  if (lags) write_parts(out, "surface_elastic", elastic);
  if (lags) out.add(kSurfaceC);
  if (!bristles.empty()) write_parts(out, "bristle_part", bristles);
  if (!bristles.empty()) out.add(kBristleC);
  out.add(
      "\n/* `first`: nothing came before, and every filter is at rest. */\n"
      "static void update_features(real step_s, int first) {\n  real s;\n"
      "  depth_m = larger(R(0.0), motion.estimate_m - SURFACE_POSITION_M);\n  s = " +
      std::string(lags ? "first ? depth_m : surface_above(step_s)" : "depth_m") +
      ";\n  (void)step_s;\n  (void)first;\n" + body + "  last_depth_m = depth_m;\n  surface_m = s;\n}\n");
}

void write_trend(CText& out, const Trend& trend, const std::vector<FeatureSpec>& features) {
  static_assert(kViscosityCoefficients == 3 && kElasticCoefficients == 4, "as in kTrendC");
  const TrendInputs inputs(features);
  const auto input = [](std::uint8_t index) { return index == TrendInputs::kNone ? "R(0.0)" : value_text(index); };
  std::string forces;
  for (std::size_t i = 0; i < inputs.force_count; ++i) forces += "force_N += " + input(inputs.force[i]) + "; ";
  out.add("\n/* ---- trend: a nonlinear viscoelastic solid ---- */\n\n");
  out.define("ELASTIC_PIECES", kElasticPieces);
  out.define("REFERENCE_DEPTH_M", trend.reference_depth_m);
  out.define("VELOCITY_LIMIT_M_PER_S", trend.velocity_limit_m_per_s);
  out.define("THINNING_VELOCITY_M_PER_S", trend.thinning_velocity_m_per_s);
  out.define("TREND_DEPTH", input(inputs.depth));
  out.define("TREND_VELOCITY", input(inputs.velocity));
  out.define("ADD_FEATURE_FORCES", forces);
  out.list("elastic", trend.elastic.pieces_N);
  out.list("viscosity", trend.viscosity_Ns_per_m);
  out.list("thinning", trend.thinning_Ns_per_m);
  out.add(kTrendC);
}

}  // namespace palpate
