// The feature vector of a force model: one to eight features of the tool's motion, with their memory. Fit, replay and
// live loop run this code. models/METHOD.md has the equations of a step; feature_lanes.h those of the parts, and why
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
