// Two forces one after the other, exact to the tick; before them a third to compare
// them with, when there is one.
//
//   idle --present--> lead_in [-> reminder -> pause] -> first -> pause -> second
//        -> finished --present--> ...
//   any  --stop-----> stopped, for good
//
// Time is counted in ticks of 1 ms, never read from a clock. Within an interval the
// force, constant or one of a pair of strokes, is let in as half a cosine, held, and taken
// away likewise; everywhere else it is zero, so that no force outlasts the one interval
// whatever the slow side does. Behind it a ForceLimiter has the last word: 4 N at most,
// 100 N/s at most, which also takes the force away gently (40 ms at most) when the
// presentation is stopped in the middle.
// Positive forces push towards the hand.
// Thread guarantee: `tick` on the haptics thread, `stop` on any, both wait-free
// and without allocation; the rest on one slow thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "engine/live/force_limiter.h"
#include "engine/live/triple_buffer.h"

namespace palpate {

inline constexpr double kStudyTick_s = 1e-3;
inline constexpr double kLargestStudyForce_N = 4.0;
inline constexpr double kFastestStudyForce_N_per_s = 100.0;
// Of every presentation, in ticks. The ramp is so long that the limiter does not bend it:
// 3.5 N x pi / 2 / 100 ms is 55 N/s.
inline constexpr std::uint32_t kLeadIn_ticks = 400;
inline constexpr std::uint32_t kRamp_ticks = 100;
inline constexpr std::uint32_t kHold_ticks = 900;
inline constexpr std::uint32_t kPause_ticks = 500;
inline constexpr std::uint32_t kInterval_ticks = 2 * kRamp_ticks + kHold_ticks;

// How much of the force is let through at the tick of an interval.
double interval_share(std::uint32_t tick) noexcept;

// What an interval presents: so many newtons, or so many times a stroke, which has a force
// for each tick of an interval and outlives the presentation.
struct Stimulus {
  double size = 0.0;
  const std::vector<double>* stroke_N = nullptr;
};
struct Stimuli {
  Stimulus first;
  Stimulus second;
  Stimulus reminder;  // a stroke, or none
};

enum class PresentationPhase : std::uint8_t {
  idle,
  lead_in,
  reminder,
  reminder_pause,
  first,
  pause,
  second,
  finished,
  stopped
};

struct PresentationState {
  std::uint64_t presentation = 0;  // which; 0: none yet
  std::uint64_t tick = 0;          // since the beginning
  std::uint64_t finished_at = 0;   // tick at which the second interval had ended
  PresentationPhase phase = PresentationPhase::idle;
  double force_N = 0.0;  // wanted now
  // What was rendered: the mean over the held ticks.
  double first_rendered_N = 0.0;
  double second_rendered_N = 0.0;
  double reminder_rendered_N = 0.0;
  double worst_N = 0.0;  // largest distance of what was rendered from what it should be
  bool limited = false;  // a force of this presentation was held back
};

class StudyPresenter {
 public:
  StudyPresenter() noexcept : limiter_(kLimits) {}

  // Slow side. Begins a presentation at the next tick (one that runs is given up);
  // returns its number.
  std::uint64_t present(const Stimuli& stimuli) noexcept;
  void stop() noexcept { stopped_.store(true, std::memory_order_release); }
  const PresentationState& newest() noexcept { return states_.newest(); }

  // Haptics thread. `rendered_N`: what the device was sent for the force that the
  // tick before returned, after whatever else limits it. Returns the force to send.
  double tick(double rendered_N) noexcept;

 private:
  static constexpr ForceLimits kLimits{kLargestStudyForce_N, kFastestStudyForce_N_per_s, 0.0};
  struct Order {
    std::uint64_t presentation = 0;
    Stimuli stimuli;
  };
  std::uint32_t length(PresentationPhase phase) const noexcept;
  const Stimulus* stimulus() const noexcept;  // of this phase; null: none
  bool is_held() const noexcept;
  double commanded_N() const noexcept;
  void read_orders() noexcept;
  void record(double rendered_N) noexcept;
  void advance() noexcept;

  TripleBuffer<Order> orders_;
  TripleBuffer<PresentationState> states_;
  std::atomic<bool> stopped_{false};
  std::uint64_t ordered_ = 0;  // slow side's

  // Haptics thread's.
  ForceLimiter limiter_;
  Order order_;
  PresentationState state_;
  std::uint32_t in_phase_ = 0;                              // ticks since the phase began
  PresentationPhase sent_phase_ = PresentationPhase::idle;  // of the force sent last
  double sent_commanded_N_ = 0.0;
  bool sent_stimulus_ = false;
  bool sent_held_ = false;
};

}  // namespace palpate
