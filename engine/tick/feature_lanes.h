// The parts of relaxation spectra and of bristles, stop operators and those that creep
// (features.h has the equations), four at a time. All branches of a filter stand in one row,
// each feature's beside one another, and so do all bristles. What they remember is the caller's:
// kMemory rows of four for each group.
// Thread guarantee: immutable after the last `add`, which allocates; all else is wait-free.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "engine/tick/lanes.h"
#include "engine/tick/rising_curve.h"

namespace palpate {

inline constexpr std::size_t kDriveCoefficients = 4;

struct DriveCurve;

// Four drives. A lane without a part has g = 0.
struct alignas(sizeof(V4)) CurveLanes {
  V4 coefficient_N[kDriveCoefficients]{};
  V4 knot_N[kDriveKnots]{};
  V4 reference_depth_m{1.0, 1.0, 1.0, 1.0};
  double least_reference_m = std::numeric_limits<double>::infinity();
  bool has_knots = false;

  void set(std::size_t lane, const DriveCurve& drive) noexcept;
};

// One step of a Maxwell branch: z' = keep z + gain (g(s') - g(s)).
struct BranchStep {
  double keep = 0.0;
  double gain = 0.0;
};
BranchStep branch_step(double relaxation_time_s, double step_s) noexcept;
// As many parts as a filter can have.
inline constexpr std::size_t kMaxLaneGroups = 16;

class BranchLanes {
 public:
  struct alignas(sizeof(V4)) Group {
    CurveLanes drive;
    V4 relaxation_time_s{1.0, 1.0, 1.0, 1.0};
    V4 slowing{};  // of these times, and the depth of its strain
    V4 slowing_depth_m{1.0, 1.0, 1.0, 1.0};
    bool slows = false;  // one of them
  };
  struct alignas(sizeof(V4)) Step {
    V4 keep;
    V4 gain;
  };
  // What a group remembers: z, and g(s) at the same time.
  static constexpr std::size_t kMemory = 2;

  // Returns the branch's place.
  std::size_t add(const DriveCurve& drive, double relaxation_time_s, double slowing = 0.0,
                  double slowing_depth_m = 1.0);
  std::size_t groups() const noexcept { return groups_.size(); }

  // The steps of all groups with the surface there; of none, where `step_s` is 0, they stay as they are.
  void prepare(double step_s, double surface_m, Step* step) const noexcept;
  // What the branches hold together after the step, with the surface there; `to` may be `from`.
  double advance(const Step* step, double surface_m, const V4* from, V4* to) const noexcept;
  // Of `count` branches from `place` on.
  static double force_N(const V4* memory, std::size_t place, std::size_t count) noexcept;

 private:
  std::vector<Group> groups_;
  std::size_t count_ = 0;
};

class BristleLanes {
 public:
  struct alignas(sizeof(V4)) Group {
    CurveLanes drive;
    V4 threshold_m{1.0, 1.0, 1.0, 1.0};
    // Further than this none bends: the threshold of a stop, nothing for one that creeps.
    V4 limit_m{1.0, 1.0, 1.0, 1.0};
    V4 air_limit_m{};     // the same out of contact
    V4 creep_per_m2_s{};  // 1 / (tau r^2); 0 of stops
    bool creeps = false;  // one of them
  };
  // What a group remembers: s, q.
  static constexpr std::size_t kMemory = 1;

  // `creep_time_s`: tau, or 0 for a stop.
  std::size_t add(const DriveCurve& drive, double threshold_m, double creep_time_s);
  std::size_t groups() const noexcept { return groups_.size(); }

  // The bristles follow the depth from the last one, for a `step_s` above 0; out of contact a
  // stop lets go. `force_N`: what they hold then.
  void advance(double last_depth_m, double depth_m, double step_s, V4* bend_m, V4* force_N) const noexcept;
  static double force_N(const V4* force_N, std::size_t place, std::size_t count) noexcept;

 private:
  std::vector<Group> groups_;
  std::size_t count_ = 0;
};

}  // namespace palpate
