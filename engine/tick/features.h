// The dynamic feature vector: what a force model is given, from one scene's
// choice of one to eight features. Recording, fitting, replay and the live
// loop run this code and no other.
//
//   depth             d = max(0, estimated position - surface)              [m]
//   velocity          v = estimated velocity while d > 0, else 0            [m/s]
//   lowpass_velocity  y with dy/dt = (dd/dt - y) / tau                      [m/s]
//   maxwell_branch    z with dz/dt = g'(d) dd/dt - z / tau                  [N]
//   maxwell_spectrum  z = sum_p z_p, each a branch with tau_p and g_p       [N]
//   stops             y = sum_p g_p(d) s_p / r_p, s_p a stop operator       [N]
//   creep             y = sum_p g_p(d) q_p / r_p, q_p a bristle that creeps
//                     by a power law                                        [N]
//   surface_lag       s - d, s the depth of the material's surface          [m]
//
// The low-pass is eq. (1) of Hoever & Harders (2009). The Maxwell branch is the
// same filter behind a spring whose stiffness g'(d) depends on depth; g is
// identified from the recording (models/training/trend_regression.h), and with g = d / tau it is the
// low-pass. Both are driven by the depth, not by the velocity estimate: free
// air relaxes the material and does not load it.
//
// The surface is where position_m is 0, or, for a model of recordings whose surface lay
// elsewhere, at the depth feature's `surface_position_m`, on either side of 0: the tool is
// in contact beyond it.
//
// With a surface_lag among the features, the branches follow the surface and not the
// tool: s = d while the elastic response E and all branches together push the tool
// out, and otherwise the s >= d at which they hold nothing, E(s) + sum z = 0. So a
// tool that retreats faster than the material comes back leaves it, and meets it
// again where it is (Johnson 1985, section 6.5: unloading of viscoelastic contacts).
// With a `slowing` b, tau becomes tau exp(b s / reference depth): a fluid that is
// squeezed through pores that close has one clock for all its times, which slows
// down with the strain (Lai & Mow 1980: permeability and strain).
//
// A branch is dissipative: with q = g(d) - z, dq/dt = z / tau, and of the store
// integral_0^d g ds - q d + integral_0^q g^-1 ds it loses
// (d - g^-1(q)) (g(d) - q) / tau >= 0 while g rises, whatever tau > 0 is just then.
//
// A stop operator of threshold r follows the depth like the tip of a bristle that
// bends by at most r and then slips: s' = clamp(s + d' - d, -r, r), and 0 out of
// contact. Several together are a Prandtl-Ishlinskii operator: dry friction with
// presliding. With every g_p >= 0 a closed cycle of depth takes the energy
//   sum_p closed integral G_p(d) dp_p / r_p >= 0,  G_p' = g_p, p_p = d - s_p,
// for p_p moves up only at d = p_p + r and down only at d = p_p - r; of a bristle that
// creeps up only at d > p_p and down only at d < p_p, which is enough.
//
// A bristle that creeps slips at every bend, by a power law of it,
//   dq/dt = dd/dt - (q / tau) (q / r)^2:
// a stop operator has the power infinity and a Maxwell branch 1. What it holds after a
// hold of t falls as t^-1/2, as networks of rubber do (Bergstrom & Boyce 1998), and its
// force over speed rises with the cube root. Free air lets it creep on.
//
// Discretisation is exact for a depth that is linear between samples, with the
// measured time step h and e = exp(-h / tau):
//   y' = e y + (1 - e) (d' - d) / h
//   z' = e z + tau (1 - e) (g(d') - g(d)) / h
// so recordings of one motion at different rates give the same features. A creeping
// bristle takes half of its step, exactly, q / sqrt(1 + (h / tau) (q / r)^2), before it
// follows the depth and half of it after (Strang 1968).
// Sources: Visintin (1994), "Differential models of hysteresis" (stop and play
// operators); Dahl (1968) (friction with presliding); Bergstrom & Boyce (1998), "Constitutive
// modeling of the large strain time-dependent behavior of elastomers".
//
// Thread guarantee: value types; `update` is wait-free, allocates nothing and
// never throws; one thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/tick/feature_lanes.h"
#include "engine/tick/motion_estimator.h"

namespace palpate {

inline constexpr std::size_t kMaxFeatures = 8;
inline constexpr std::size_t kMaxFeatureParts = 8;

enum class FeatureKind {
  depth,
  velocity,
  lowpass_velocity,
  maxwell_branch,
  maxwell_spectrum,
  stops,
  creep,
  surface_lag
};

struct FeatureKindFacts {
  std::string_view name;   // in model files and column names
  std::string_view unit;   // as a column name ends
  bool has_time = false;   // one time constant
  bool has_drive = false;  // a drive of its own
  bool has_parts = false;
  bool is_branch = false;   // made of Maxwell branches
  bool is_bristle = false;  // or of bristles
};
// One row a kind, in their order.
inline constexpr std::array<FeatureKindFacts, 8> kFeatureKinds{{
    {.name = "depth", .unit = "_m"},
    {.name = "velocity", .unit = "_m_per_s"},
    {.name = "lowpass_velocity", .unit = "s_m_per_s", .has_time = true},
    {.name = "maxwell_branch", .unit = "s_N", .has_time = true, .has_drive = true, .is_branch = true},
    {.name = "maxwell_spectrum", .unit = "s_N", .has_parts = true, .is_branch = true},
    {.name = "stops", .unit = "mm_N", .has_parts = true, .is_bristle = true},
    {.name = "creep", .unit = "s_N", .has_parts = true, .is_bristle = true},
    {.name = "surface_lag", .unit = "_m", .has_drive = true},
}};
constexpr const FeatureKindFacts& facts_of(FeatureKind kind) noexcept {
  return kFeatureKinds[static_cast<std::size_t>(kind)];
}
constexpr bool has_time(FeatureKind kind) noexcept { return facts_of(kind).has_time; }
constexpr bool has_drive(FeatureKind kind) noexcept { return facts_of(kind).has_drive; }
constexpr bool has_parts(FeatureKind kind) noexcept { return facts_of(kind).has_parts; }
constexpr bool is_branch(FeatureKind kind) noexcept { return facts_of(kind).is_branch; }
constexpr bool is_bristle(FeatureKind kind) noexcept { return facts_of(kind).is_bristle; }

// g(d) = sum_k coefficient_N[k] u^(k+1) with u = d / reference_depth_m, for
// u <= 1; beyond, g continues along its tangent at u = 1. With knots it is a cubic
// spline (rising_curve.h): their sum comes on top.
struct DriveCurve {
  double reference_depth_m = 1.0;
  std::array<double, kDriveCoefficients> coefficient_N{};
  bool has_knots = false;
  std::array<double, kDriveKnots> knot_N{};

  double at(double depth_m) const noexcept;
  bool operator==(const DriveCurve&) const = default;
};

// One branch of a maxwell_spectrum, one stop operator or one creeping bristle.
struct FeaturePart {
  double relaxation_time_s = 0.0;  // maxwell_spectrum; tau of creep
  double threshold_m = 0.0;        // r of stops and creep
  DriveCurve drive;                // g_p; of stops and creep never negative

  bool operator==(const FeaturePart&) const = default;
};

struct FeatureSpec {
  FeatureKind kind = FeatureKind::depth;
  double relaxation_time_s = 0.0;  // lowpass_velocity, maxwell_branch
  DriveCurve drive{};              // maxwell_branch; of surface_lag E
  std::size_t part_count = 0;      // maxwell_spectrum, stops and creep
  std::array<FeaturePart, kMaxFeatureParts> parts{};
  double slowing = 0.0;             // b of maxwell_branch and maxwell_spectrum
  double surface_position_m = 0.0;  // depth: for all features beside it

  bool operator==(const FeatureSpec&) const = default;
};

// The material's surface halfway through a step: between the last surface and the tool, or,
// where the tool had left it and has not come back, still there.
double surface_halfway(double last_surface_m, double last_depth_m, double depth_m) noexcept;
// What a `slowing` makes of the relaxation times with the surface there.
double branch_clock(double slowing, double surface_m, double reference_depth_m) noexcept;

// Where the surface lies on the axis of position_m: what the depth feature says.
double surface_position_m(const std::vector<FeatureSpec>& specs) noexcept;

// Column name with unit, e.g. "depth_m", "lowpass_velocity_0.17s_m_per_s".
std::string feature_name(const FeatureSpec& spec);

struct FeatureVector {
  std::array<double, kMaxFeatures> values{};
  double depth_m = 0.0;  // from the raw position: max(0, position - surface)
  bool in_contact = false;
};

// All that the filters behind one scene's features remember of a stream. Trivially copyable.
struct alignas(sizeof(V4)) FeatureState {
  FeatureVector vector;
  double depth_m = 0.0;    // at the last sample
  double surface_m = 0.0;  // s, at least the depth; it without a surface_lag
  double time_s = 0.0;
  bool started = false;
  // Of the branches, then of the bristles: features have at most 16 groups of parts.
  V4 memory[BranchLanes::kMemory * kMaxLaneGroups]{};
};
static_assert(std::is_trivially_copyable_v<FeatureState>);

// What does not change: the features, their parts in lanes, and where the surface lies.
// Thread guarantee: immutable; constructing allocates, all else is wait-free.
class FeaturePlan {
 public:
  // `specs`: 1 to 8 features; relaxation times > 0.
  explicit FeaturePlan(const std::vector<FeatureSpec>& specs);

  const std::vector<FeatureSpec>& specs() const noexcept { return specs_; }

  // `sample` and its motion estimate; times increase. The contact state is
  // that of the raw position at this surface.
  void update(FeatureState& state, const ToolSample& sample, const MotionEstimate& motion) const noexcept;
  // After an `update`: takes over the memory that `before`, fed with the same motion, has of
  // the same features of `plan`, so that a change of models loses none. A stop's bend depends
  // on its threshold alone; all else, and where the surface lies, must be equal.
  void adopt(FeatureState& state, const FeaturePlan& plan, const FeatureState& before) const noexcept;

 private:
  double advance_branches(FeatureState& state, double depth_m, double step_s) const noexcept;
  void take_bristles(FeatureState& state, const V4* bristle_N) const noexcept;
  V4* bends(FeatureState& state) const noexcept { return state.memory + BranchLanes::kMemory * branches_.groups(); }
  const V4* bends(const FeatureState& state) const noexcept {
    return state.memory + BranchLanes::kMemory * branches_.groups();
  }

  std::vector<FeatureSpec> specs_;
  std::array<std::size_t, kMaxFeatures> place_{};  // of its first part in the lanes
  BranchLanes branches_;
  BristleLanes bristles_;
  std::size_t lag_ = kMaxFeatures;  // which feature is the surface_lag; none
  double surface_position_m_ = 0.0;
};

// Both for one stream of samples.
class FeatureFilter {
 public:
  explicit FeatureFilter(const std::vector<FeatureSpec>& specs) : plan_(specs) {}

  const FeaturePlan& plan() const noexcept { return plan_; }
  const FeatureState& state() const noexcept { return state_; }
  void reset() noexcept { state_.started = false; }
  // Of the last sample; minus infinity before the first.
  double time_s() const noexcept { return state_.started ? state_.time_s : -std::numeric_limits<double>::infinity(); }
  const FeatureVector& update(const ToolSample& sample, const MotionEstimate& motion) noexcept {
    plan_.update(state_, sample, motion);
    return state_.vector;
  }
  void adopt(const FeatureFilter& before) noexcept { plan_.adopt(state_, before.plan_, before.state_); }
  // What `update` gave last.
  const FeatureVector& vector() const noexcept { return state_.vector; }
  double surface_m() const noexcept { return state_.surface_m; }

 private:
  FeaturePlan plan_;
  FeatureState state_;
};

}  // namespace palpate
