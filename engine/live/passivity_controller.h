// Keeps the rendered force from giving back more energy than it took. A force that
// is held for a tick and comes late acts as negative damping, -K (T / 2 + t_d) beside
// a stiffness K (Colgate & Schenkel 1997); where neither the material nor the hand
// has that much, the tool is driven.
//
// Observer: the energy that the tool has put in since it touched,
//   E += F dx,  F the force that arrived meanwhile: written as long ago as the transport takes, in time-domain
//   passivity with the delay in the observer (Ryu et al. 2004), and the mean of them where samples come less often than
//   ticks.
// A material that only stores and relaxes never returns more over a way in and out
// again than it took: at each depth, on the way out, E is no less than it was when
// that depth was last passed on the way in. What is missing is the debt. (The usual
// condition, E >= 0, sees a leak only when all that is stored has leaked.)
// An encoder that flickers between two of its steps moves nothing: the observer follows
// the depth with a play of one step, which lets F times as much go unseen at each turn.
// Controller: on the way out, v < 0, the force is lowered by min(b, debt / (v^2 T)) |v|
// until the debt is repaid; b is what StabilityLimit leaves beside other damping. It takes force away and never adds
// any, and where there is no debt it does nothing at all. Another active model is another material: what was passed
// before says nothing of it, and forces that fade into each other are no leak. The observer then begins anew. Source:
// Hannaford & Ryu (2002), IEEE Trans. Robotics & Automation 18(1); the reference that follows the depth in the manner
// of Ryu et al. (2004). Thread guarantee: one thread at a time; wait-free, allocates nothing, never throws.
#pragma once

#include <array>
#include <cstddef>

namespace palpate {

inline constexpr double kHapticTick_s = 1e-3;

class PassivityController {
 public:
  // `encoder_step_m`: 0 without an encoder.
  explicit PassivityController(double encoder_step_m = 0.0) noexcept;

  struct Tool {
    double depth_m = 0.0;  // of the sample, as the encoder has it
    double velocity_m_per_s = 0.0;
    bool in_contact = false;
    bool other_material = false;  // the active model is being exchanged
    bool fresh = true;            // a sample came in this tick
  };
  struct Loop {
    double transport_s = 1e-3;       // from a sample to the force that answers it; 60 ms at most are seen
    double damping_Ns_per_m = 16.0;  // b
    double hold_s = 1e-3;            // T, for which a force is held: a tick, or until the next sample
  };

  // Once a tick, before the limiter. `written_N`: what the device was given in the
  // tick before; `step_s` > 0 since then. Returns `commanded_N` or less, not below 0
  // unless it is; not finite where `commanded_N` is not.
  double apply(double commanded_N, const Tool& tool, const Loop& loop, double written_N, double step_s) noexcept;

  double debt_J() const noexcept { return debt_J_; }

 private:
  struct Passed {
    double depth_m = 0.0;
    double energy_J = 0.0;
  };
  static constexpr std::size_t kMostPassed = 256;
  static constexpr double kSpacing_m = 20e-6;
  static constexpr std::size_t kMostUnderWay = 64;

  void begin_at(double depth_m) noexcept;
  double arrived_N(const Tool& tool, double transport_s, double written_N, double step_s) noexcept;
  double less(double commanded_N, double less_N) noexcept;
  void pass_inwards(double depth_m, double energy_J) noexcept;
  double energy_when_passed(double depth_m) noexcept;

  double play_m_;
  // The depths passed on the way to here and not yet on the way back, ascending. The first
  // is where the observer began, with nothing put in: the surface, or further in.
  std::array<Passed, kMostPassed> passed_{};
  std::size_t count_ = 1;
  double energy_J_ = 0.0;
  double debt_J_ = 0.0;
  double depth_m_ = 0.0;                           // at the tick before, with the play
  std::array<double, kMostUnderWay> written_N_{};  // of the last ticks, a ring
  std::size_t ticks_ = 0;
  double arrived_N_ = 0.0;  // sum over the ticks since the last sample
  int arrivals_ = 0;
  double less_N_ = 0.0;  // taken in this tick
};

}  // namespace palpate
