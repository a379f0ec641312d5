// The feature vector of a force model: one to eight features of the tool's motion, with their memory. Fit, replay and
// live loop run this code. models/METHOD.md has the equations of a step; below are those of the parts, and why
// they are passive.
//   depth             d = max(0, estimated position - surface)              [m]
//   velocity          v = estimated velocity while d > 0, else 0            [m/s]
//   lowpass_velocity  y with dy/dt = (dd/dt - y) / tau                      [m/s]
//   maxwell_spectrum  sum of branches z                                     [N]
//   stops, creep      sum of bristles                                       [N]
// The tool is in contact beyond the depth feature's `surface_position_m`. In free air the material relaxes.
// A stream begins at rest: nothing was pressed before. One that begins in contact, nearer to the end of a training
// recording than to the beginning of any, continues that recording: it begins with the memory of that end.
// Sources: Hoever & Harders (2009), eq. 1 (low-pass); Visintin (1994) (stops); Bergstrom & Boyce (1998) (creep);
// Lai & Mow (1980) (slowing).
// Thread guarantee: value types; `update` is wait-free, allocates nothing and never throws; one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/tick/motion_estimator.h"

namespace palpate {

// The parts of features, each with a drive curve g of the depth d, four at a time in SIMD lanes, with arithmetic
// operations only, so that results are bit-identical on every processor:
//   Maxwell branch     dz/dt = g'(d) dd/dt - z / tau: a spring g and a dashpot in series. g = d / tau: a low-pass.
//   stop operator      s' = clamp(s + d' - d, -r, r), 0 out of contact: a bristle that bends by at most r, then slips.
//   creeping bristle   dq/dt = dd/dt - (q / tau) (q / r)^2: slips at every deflection; a hold: t^-1/2.
// A `slowing` b multiplies every tau by exp(b d / reference depth): where a fluid is squeezed through closing pores.
//
// Every part is passive if g rises (branch) or is not negative (bristles). With q = g(d) - z, dq/dt = z / tau, a branch
// dissipates (d - g^-1(q)) (g(d) - q) / tau >= 0 for any tau; the rest of its power changes the stored energy
// integral_0^d g ds - q d + integral_0^q g^-1 ds. Bristles dissipate sum_p closed integral G_p(d) dp_p / r_p >= 0 in a
// cycle, with G_p' = g_p and p_p = d - s_p, which increases only at d > p_p and decreases only at d < p_p.
// Thread guarantee: immutable after the last `add`, which allocates; all else is wait-free.

inline constexpr std::size_t kDriveCoefficients = 4;

// Sets `value` to g(d), a force at depth d: a Maxwell branch before it relaxes, or the friction of a bristle.
//   g(d) = sum_k coefficient_N[k] u^(k+1),  u = d / reference_depth_m
// Beyond u = 1, g continues along its tangent. `curve`: a DriveCurve for one Number, or CurveLanes for four at once;
// the results are bit-identical.
template <typename Number, typename Curve>
[[gnu::always_inline]] inline void evaluate_curve(Number& value, const Curve& curve, double depth_m) noexcept {
  const Number u = depth_m * curve.per_reference_m();
  const Number inside = u < 1.0 ? u : Number{} + 1.0;
  value = curve.coefficient_N[kDriveCoefficients - 1] * inside;
  for (std::size_t k = kDriveCoefficients - 1; k-- > 0;) value = (value + curve.coefficient_N[k]) * inside;
  if (depth_m > curve.least_reference_m()) [[unlikely]] {
    Number slope{};  // dg/du at u = 1
    for (std::size_t k = kDriveCoefficients; k-- > 0;) slope += static_cast<double>(k + 1) * curve.coefficient_N[k];
    value = u > 1.0 ? value + slope * (u - 1.0) : value;
  }
}

struct DriveCurve {
  double reference_depth_m = 1.0;
  std::array<double, kDriveCoefficients> coefficient_N{};

  double at(double depth_m) const noexcept {
    double value = 0.0;
    evaluate_curve(value, *this, depth_m);
    return value;
  }
  double per_reference_m() const noexcept { return 1.0 / reference_depth_m; }
  // Beyond this depth g is linear.
  double least_reference_m() const noexcept { return reference_depth_m; }
  bool operator==(const DriveCurve&) const = default;
};

inline constexpr std::size_t kLanes = 4;

// Four doubles (extension of GCC and Clang). Passed by reference only, because by value the ABI depends on the
// instruction set. Arrays of it are stored as V4, because a load of a vector that was stored in halves stalls. A struct
// with V4 members needs alignas(sizeof(V4)), which GCC omits when it compiles for processors without such vectors.
using V4 [[gnu::vector_size(kLanes * sizeof(double))]] = double;
#define PALPATE_INLINE [[gnu::always_inline]] inline

// Replaces x, clamped to -700 to 700, by exp(x); the error is at most 1 ulp.
//   x = k ln 2 + r, |r| <= ln 2 / 2;  exp(x) = 2^k sum_(n <= 13) r^n / n!
// Source: Cody & Waite (1980), "Software manual for the elementary functions", chapter 6.
PALPATE_INLINE void to_exponential(V4& x) noexcept {
  using Integers [[gnu::vector_size(kLanes * sizeof(std::int64_t))]] = std::int64_t;
  // The sum of this and a number has the number, rounded to an integer, in its lowest bits.
  constexpr double kRound = 0x1.8p52;
  constexpr int kExponentBit = 52;
  constexpr std::int64_t kOne = std::int64_t{1023} << kExponentBit;  // the bits of 1.0
  x = x < -700.0 ? V4{} - 700.0 : x;
  x = x > 700.0 ? V4{} + 700.0 : x;
  const V4 shifted = x * 0x1.71547652b82fep0 + kRound;  // log2(e)
  const V4 k = shifted - kRound;
  // ln 2 in two parts, the first so short that its product with k is exact.
  const V4 r = (x - k * 0x1.62e42feep-1) - k * 0x1.a39ef35793c76p-33;
  const V4 r2 = r * r;
  const V4 r4 = r2 * r2;
  const V4 low = (1.0 / 2 + r * (1.0 / 6)) + r2 * (1.0 / 24 + r * (1.0 / 120));
  const V4 middle = (1.0 / 720 + r * (1.0 / 5040)) + r2 * (1.0 / 40320 + r * (1.0 / 362880));
  const V4 high = (1.0 / 3628800 + r * (1.0 / 39916800)) + r2 * (1.0 / 479001600 + r * (1.0 / 6227020800));
  const V4 rest = r + r2 * (low + r4 * (middle + r4 * high));
  const V4 power = reinterpret_cast<V4>((reinterpret_cast<Integers>(shifted) << kExponentBit) + kOne);  // 2^k
  x = power + power * rest;
}

// Four drive curves. An unused lane has g = 0.
struct alignas(sizeof(V4)) CurveLanes {
  V4 coefficient_N[kDriveCoefficients]{};
  V4 per_reference{1.0, 1.0, 1.0, 1.0};
  double least_m = std::numeric_limits<double>::infinity();  // the smallest of the four reference depths

  void set(std::size_t lane, const DriveCurve& drive) noexcept;
  const V4& per_reference_m() const noexcept { return per_reference; }
  double least_reference_m() const noexcept { return least_m; }
};

// The exponential of a multiple of 1/32, kept from step to step: the argument seldom moves to another multiple, and a
// short series leads from one to it. Results do not depend on what was kept.
template <typename Number>
struct alignas(sizeof(Number)) KeptExponential {
  Number at{};
  Number value = Number{} + 1.0;
};

// The largest number of groups of four for the branches or bristles of a filter: 8 features of 8 parts.
inline constexpr std::size_t kMaxLaneGroups = 16;

// The state of the parts of a filter: the groups of branches, then those of bristles.
struct alignas(sizeof(V4)) PartMemory {
  V4 value[kMaxLaneGroups];                        // the force z of a branch, N; the deflection s or q of a bristle, m
  V4 drive_N[kMaxLaneGroups];                      // g(d) of a branch at the same time; the force of a bristle
  KeptExponential<double> slowed[kMaxLaneGroups];  // of a step of the branches
  KeptExponential<V4> kept[kMaxLaneGroups];
};

// The sum of `count` lanes from index `first`.
inline double sum_of_lanes(const V4* value, std::size_t first, std::size_t count) noexcept {
  const double* const lane = reinterpret_cast<const double*>(value) + first;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += lane[i];
  return sum;
}

class BranchLanes {
 public:
  struct alignas(sizeof(V4)) Group {
    CurveLanes drive;
    V4 relaxation_time_s{1.0, 1.0, 1.0, 1.0};
    V4 rate_per_s{1.0, 1.0, 1.0, 1.0};
    // An exponent of these rates that grows with depth; that of the group before unless `slows`.
    double per_slowing = 0.0, per_slowing_m = 1.0;
    bool slows = false;
  };
  // Returns the index of the branch among the lanes.
  std::size_t add(const DriveCurve& drive, double relaxation_time_s, double slowing = 0.0,
                  double slowing_depth_m = 1.0);
  std::size_t groups() const noexcept { return groups_.size(); }

  // Advances all branches from the last depth by `step_s`; with 0 no force changes.
  void advance(double last_depth_m, double depth_m, double step_s, PartMemory& memory) const noexcept;

 private:
  std::vector<Group> groups_;
  std::size_t count_ = 0;
};

class BristleLanes {
 public:
  struct alignas(sizeof(V4)) Group {
    CurveLanes drive;
    V4 per_threshold_m{1.0, 1.0, 1.0, 1.0};
    // The largest deflection: the threshold of a stop, infinite for a creeping bristle.
    V4 limit_m{1.0, 1.0, 1.0, 1.0};
    V4 air_limit_m{};     // the same out of contact: 0 for a stop
    V4 creep_per_m2_s{};  // 1 / (tau r^2); 0 for a stop
    bool creeps = false;  // whether one lane creeps
  };
  // `creep_time_s`: tau, or 0 for a stop. Returns the index of the bristle among the lanes.
  std::size_t add(const DriveCurve& drive, double threshold_m, double creep_time_s);
  std::size_t groups() const noexcept { return groups_.size(); }

  // Advances all bristles from the last depth by `step_s`; with 0 only the forces are computed. Out of contact the
  // deflection of a stop becomes 0. `force_N`: receives the forces.
  void advance(double last_depth_m, double depth_m, double step_s, V4* bend_m, V4* force_N) const noexcept;

 private:
  std::vector<Group> groups_;
  std::size_t count_ = 0;
};

inline constexpr std::size_t kMaxFeatures = 8;
inline constexpr std::size_t kMaxFeatureParts = 8;

enum class FeatureKind { depth, velocity, lowpass_velocity, maxwell_spectrum, stops, creep };

struct FeatureKindFacts {
  std::string_view name;    // in model files and column names
  std::string_view unit;    // end of the column name
  bool has_time = false;    // has one time constant
  bool is_branch = false;   // consists of Maxwell branches
  bool is_bristle = false;  // consists of bristles
};
// One row for each kind, in the order of FeatureKind.
inline constexpr std::array<FeatureKindFacts, 6> kFeatureKinds{{
    {.name = "depth", .unit = "_m"},
    {.name = "velocity", .unit = "_m_per_s"},
    {.name = "lowpass_velocity", .unit = "s_m_per_s", .has_time = true},
    {.name = "maxwell_spectrum", .unit = "s_N", .is_branch = true},
    {.name = "stops", .unit = "mm_N", .is_bristle = true},
    {.name = "creep", .unit = "s_N", .is_bristle = true},
}};
constexpr const FeatureKindFacts& facts_of(FeatureKind kind) noexcept {
  return kFeatureKinds[static_cast<std::size_t>(kind)];
}
constexpr bool has_time(FeatureKind kind) noexcept { return facts_of(kind).has_time; }
constexpr bool is_branch(FeatureKind kind) noexcept { return facts_of(kind).is_branch; }
constexpr bool is_bristle(FeatureKind kind) noexcept { return facts_of(kind).is_bristle; }
// Is a sum of up to kMaxFeatureParts parts.
constexpr bool has_parts(FeatureKind kind) noexcept { return is_branch(kind) || is_bristle(kind); }

// One branch of a maxwell_spectrum, one stop operator or one creeping bristle.
struct FeaturePart {
  double relaxation_time_s = 0.0;  // maxwell_spectrum; tau of creep
  double threshold_m = 0.0;        // r of stops and creep
  DriveCurve drive;                // g_p; >= 0 for stops and creep

  bool operator==(const FeaturePart&) const = default;
};

struct FeatureSpec {
  FeatureKind kind = FeatureKind::depth;
  double relaxation_time_s = 0.0;  // lowpass_velocity
  std::size_t part_count = 0;      // maxwell_spectrum, stops and creep
  std::array<FeaturePart, kMaxFeatureParts> parts{};
  double slowing = 0.0;             // b of maxwell_spectrum
  double surface_position_m = 0.0;  // of the depth feature; valid for all features

  bool operator==(const FeatureSpec&) const = default;
};

// The parts of a feature; a low-pass is a branch that is driven by d / tau.
std::vector<FeaturePart> parts_of(const FeatureSpec& spec);

// The position of the surface: that of the depth feature; 0 without one.
double surface_position_m(const std::vector<FeatureSpec>& specs) noexcept;

// Column name with unit, e.g. "feature_depth_m", "feature_lowpass_velocity_0.17s_m_per_s".
std::string feature_name(const FeatureSpec& spec);

// The beginning and the end of a training recording, positions and force as recorded, and the memory of the features at
// the end: in their order the value of a low-pass, N of each branch, m of each bristle.
struct RecordingEnds {
  double first_position_m = 0.0, last_position_m = 0.0;
  std::vector<double> memory;
  double first_force_N = 0.0;

  bool operator==(const RecordingEnds&) const = default;
};
// The number of values of such a memory.
std::size_t memory_size(const std::vector<FeatureSpec>& specs) noexcept;

// How a stream began; values of 0 and above are indices of the RecordingEnds that it continues.
inline constexpr int kBeganAtRest = -1;
inline constexpr int kBeganAsTold = -2;  // after a given motion (HapticsTick::start_after)

struct FeatureVector {
  std::array<double, kMaxFeatures> values{};
  bool in_contact = false;  // by the raw position
};

// The state of the filters of one list of features. Trivially copyable.
struct alignas(sizeof(V4)) FeatureState {
  FeatureVector vector;
  double depth_m = 0.0;  // at the last sample, at most the deepest of the plan
  double time_s = 0.0;
  bool started = false;
  int began = kBeganAtRest;
  PartMemory memory{};
};
static_assert(std::is_trivially_copyable_v<FeatureState>);

// The immutable part of a filter: the features, their parts in lanes, and the surface.
// Thread guarantee: immutable; constructing allocates, all else is wait-free.
class FeaturePlan {
 public:
  // `specs`: 1 to 8 features; relaxation times > 0. `deepest_m`: a greater depth enters the memory of the features as
  // this one, so that an error of the sensor, or a press far beyond the training data, is soon forgotten.
  explicit FeaturePlan(const std::vector<FeatureSpec>& specs,
                       double deepest_m = std::numeric_limits<double>::infinity(),
                       const std::vector<RecordingEnds>& ends = {});

  const std::vector<FeatureSpec>& specs() const noexcept { return specs_; }
  bool is_of(const std::vector<FeatureSpec>& specs, double deepest_m,
             const std::vector<RecordingEnds>& ends) const noexcept {
    return deepest_m_ == deepest_m && specs_ == specs && ends_ == ends;
  }

  // Begins a stream whose first sample, the next to `update`, is this one.
  void begin(FeatureState& state, const ToolSample& sample) const noexcept;
  // The memory of a state, as in RecordingEnds. Allocates.
  std::vector<double> memory_of(const FeatureState& state) const;

  // Advances `state` by a sample and its motion estimate; times increase. Contact is determined from the raw position.
  void update(FeatureState& state, const ToolSample& sample, const MotionEstimate& motion) const noexcept;
  // To be called after an `update`. For each feature that `plan` has, too, copies value and memory from `before`, the
  // state of `plan` after the same motion, so that a change of models keeps the memory of the material. Other features
  // keep the state of the recalled motion (HapticsTick::recall). With unequal surface positions nothing is copied.
  void adopt(FeatureState& state, const FeaturePlan& plan, const FeatureState& before) const noexcept;

 private:
  // Replaces each value of the memory of `state`, in the order of RecordingEnds, by the result of `use`.
  void each_memory(FeatureState& state, const auto& use) const;

  std::vector<FeatureSpec> specs_;
  std::vector<RecordingEnds> ends_;
  std::array<std::size_t, kMaxFeatures> first_lane_{}, lanes_{};  // of each feature in PartMemory
  BranchLanes branches_;
  BristleLanes bristles_;
  double surface_position_m_ = 0.0, deepest_m_;
};

// A plan and a state, for one stream of samples.
class FeatureFilter {
 public:
  explicit FeatureFilter(const std::vector<FeatureSpec>& specs,
                         double deepest_m = std::numeric_limits<double>::infinity(),
                         const std::vector<RecordingEnds>& ends = {})
      : plan_(specs, deepest_m, ends) {}

  const FeaturePlan& plan() const noexcept { return plan_; }
  const FeatureState& state() const noexcept { return state_; }
  void reset() noexcept { state_ = {}; }
  void begin(const ToolSample& sample) noexcept { plan_.begin(state_, sample); }
  // Declares that the motion so far preceded the stream that begins now.
  void begin_as_told() noexcept { state_.began = kBeganAsTold; }
  // The time of the last sample; minus infinity before the first.
  double time_s() const noexcept { return state_.started ? state_.time_s : -std::numeric_limits<double>::infinity(); }
  const FeatureVector& update(const ToolSample& sample, const MotionEstimate& motion) noexcept {
    plan_.update(state_, sample, motion);
    return state_.vector;
  }
  void adopt(const FeatureFilter& before) noexcept { plan_.adopt(state_, before.plan_, before.state_); }
  // The result of the last `update`.
  const FeatureVector& vector() const noexcept { return state_.vector; }

 private:
  FeaturePlan plan_;
  FeatureState state_;
};

}  // namespace palpate
