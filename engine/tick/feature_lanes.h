// The parts of relaxation spectra and of bristles, stop operators and those that creep
// (features.h has the equations), four at a time. All branches of a filter stand in one row,
// each feature's beside one another, and so do all bristles.
// Thread guarantee: value types; constructors allocate, all else is wait-free; one thread at
// a time.
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
    V4 clock{1.0, 1.0, 1.0, 1.0};  // what a slowing makes of them
    V4 keep{};
    V4 gain{};
  };
  // z, and g(s) at the same time.
  struct alignas(sizeof(V4)) States {
    V4 force_N[kMaxLaneGroups]{};
    V4 drive_N[kMaxLaneGroups]{};
  };

  // Returns the branch's place.
  std::size_t add(const DriveCurve& drive, double relaxation_time_s);
  bool empty() const noexcept { return count_ == 0; }

  void set_clock(std::size_t place, double clock) noexcept { groups_[place / kLanes].clock[place % kLanes] = clock; }
  // The steps of all branches, after their clocks.
  void prepare(double step_s) noexcept;
  // What the branches would hold together with the surface there.
  double held_N(double surface_m) noexcept;
  // Takes the step to there.
  void advance(double surface_m) noexcept;
  // No step: at rest, or as they are, with the surface there.
  void stay(double surface_m, bool at_rest) noexcept;
  // Of `count` branches from `place` on.
  double force_N(std::size_t place, std::size_t count) const noexcept;
  void adopt(std::size_t place, const BranchLanes& from, std::size_t other) noexcept;

 private:
  std::vector<Group> groups_;
  std::size_t count_ = 0;
  std::size_t now_ = 0;  // of the two
  std::array<States, 2> states_{};
  double held_at_m_ = std::numeric_limits<double>::quiet_NaN();  // of those that are not now
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
    V4 bend_m{};          // s, q
    bool creeps = false;  // one of them
  };

  // `creep_time_s`: tau, or 0 for a stop.
  std::size_t add(const DriveCurve& drive, double threshold_m, double creep_time_s);
  bool empty() const noexcept { return count_ == 0; }

  // The bristles follow the depth from the last one; out of contact a stop lets go.
  void advance(double last_depth_m, double depth_m, double step_s) noexcept;
  // They stay as they are, and their forces are those of the depth.
  void stay(double depth_m) noexcept;
  void release() noexcept;
  double force_N(std::size_t place, std::size_t count) const noexcept;
  // The bend alone: `stay` gives the forces.
  void adopt(std::size_t place, const BristleLanes& from, std::size_t other) noexcept;

 private:
  std::vector<Group> groups_;
  std::size_t count_ = 0;
  alignas(sizeof(V4)) V4 force_N_[kMaxLaneGroups]{};
};

}  // namespace palpate
