// Presents two forces one after the other with the accuracy of a tick, optionally after a third one as a reminder:
//   lead-in [-> reminder -> pause] -> first -> pause -> second
// Time is counted in ticks of 1 ms. Within an interval the force, constant or a stroke, is multiplied by a cosine ramp
// at its beginning and end. Outside of the intervals it is zero, so that no force lasts longer than its interval, even
// if the slow side hangs. A ForceLimiter limits the result to 4 N and 100 N/s; it also ramps the force down within
// 40 ms when a presentation is stopped. Positive forces push towards the hand.
// Thread guarantee: `tick` on the haptics thread, `stop` on any, both wait-free and without allocation; the rest on one
// slow thread.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "engine/live/force_limiter.h"
#include "engine/live/handover.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

inline constexpr double kLargestStudyForce_N = 4.0;
inline constexpr double kFastestStudyForce_N_per_s = 100.0;
// Durations in ticks. The ramp stays below the limiter's slew rate: 3.5 N x pi / 2 / 100 ms = 55 N/s.
inline constexpr std::uint32_t kLeadIn_ticks = 400;
inline constexpr std::uint32_t kRamp_ticks = 100;
inline constexpr std::uint32_t kHold_ticks = 900;
inline constexpr std::uint32_t kPause_ticks = 500;
inline constexpr std::uint32_t kInterval_ticks = 2 * kRamp_ticks + kHold_ticks;

// The factor of the force at a tick of an interval, 0 to 1: cosine ramps at both ends, 1 between them.
double interval_share(std::uint32_t tick) noexcept;
// Whether a tick of an interval is between the ramps.
constexpr bool is_held(std::uint32_t tick) noexcept { return tick >= kRamp_ticks && tick < kRamp_ticks + kHold_ticks; }

// The force of an interval: `size` in newtons, or `size` times a stroke. A stroke has one force per tick of an interval
// and outlives the presentation.
struct Stimulus {
  double size = 0.0;
  const std::vector<double>* stroke_N = nullptr;

  double force_N(std::uint32_t tick) const noexcept;  // with the ramps
};
using Stimuli = std::array<Stimulus, 3>;  // the reminder, the first and the second
// Constant stimuli have none: the first element has no stroke.
inline bool has_reminder(const Stimuli& stimuli) noexcept { return stimuli[0].stroke_N != nullptr; }

struct PresentationState {
  std::uint64_t presentation = 0;      // number of the presentation, from 1; 0: none yet
  std::uint64_t tick = 0;              // since the presenter was made
  std::uint64_t finished_at = 0;       // tick after the end of the second interval; 0: not finished
  int interval = -1;                   // that is presented now, an index of Stimuli; -1 none
  bool limited = false;                // the limiter changed a force of this presentation
  double worst_N = 0.0;                // largest |rendered - commanded force| in the intervals
  std::array<double, 3> rendered_N{};  // means between the ramps, by interval
};

class StudyPresenter {
 public:
  // Slow side. Begins a presentation at the next tick and cancels a running one. Returns its number.
  std::uint64_t present(const Stimuli& stimuli) noexcept;
  void stop() noexcept { stopped_.store(true, std::memory_order_release); }  // permanently
  const PresentationState& newest() noexcept { return states_.newest(); }

  // Haptics thread. `rendered_N`: the force that the device received for the return value of the previous tick, after
  // all other limits. Returns the force to render.
  double tick(double rendered_N) noexcept;

 private:
  struct Order {
    std::uint64_t presentation = 0;
    Stimuli stimuli;
  };
  void record(double rendered_N) noexcept;
  double next_command_N() noexcept;

  TripleBuffer<Order> orders_;
  TripleBuffer<PresentationState> states_;
  std::atomic<bool> stopped_{false};
  std::uint64_t ordered_ = 0;  // slow side

  // Haptics thread.
  ForceLimiter limiter_{ForceLimits{kLargestStudyForce_N, kFastestStudyForce_N_per_s, 0.0}};
  PresentationState state_;
  std::uint32_t played_ = 0;       // ticks since the presentation began
  std::uint32_t in_interval_ = 0;  // of the last command
  double commanded_N_ = 0.0;       // by the last tick
};

}  // namespace palpate
