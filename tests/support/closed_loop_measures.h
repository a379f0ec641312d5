// Measures for the tests of the closed loop: the residual motion of a hand that holds still, and
// the energy that a tool exchanges with the rendered force in cycles and strokes.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenes/hard/hard.h"
#include "tests/support/fitting.h"
#include "tests/support/rt_guard.h"

namespace palpate::test {

using ForcePtr = std::shared_ptr<const ForceModel>;

// Counts the offences of all ticks; 0 if rt_guard_works() is false.
class GuardedLoop final : public ClosedLoop {
 public:
  using ClosedLoop::ClosedLoop;
  int offences() const { return offences_; }

 private:
  const LoopSnapshot& tick() override {
    RtGuard guard;
    const LoopSnapshot& snapshot = ClosedLoop::tick();
    offences_ += guard.stop().total();
    return snapshot;
  }
  int offences_ = 0;
};

// The timing of ticks.
enum class Ticking {
  even,      // every millisecond
  jittered,  // each independently up to 0.45 ms late
  gaps,      // jittered, one in 30 left out, and one gap of 5 ms in each 100 ms
};
// For ClosedLoopSettings::uneven.
std::function<std::int64_t(std::int64_t& deadline)> ticks(Ticking ticking);

// A grip so stiff that the tool follows the prescribed path.
inline Grip lead() { return {"lead", 1.0, 4e5, 1200.0}; }

inline constexpr double kOneTick_s = 1e-3;
inline constexpr double kEncoders_m[] = {30e-6, 5e-6};
inline constexpr Ticking kTickings[] = {Ticking::even, Ticking::jittered, Ticking::gaps};

// Models of a virtual material, fitted once per process: one of each method for maxwell and stiff, with the features
// of their scenes; of the others trend, direct, voxel and greedy, with the features that the recording selects.
const std::vector<ModelPtr>& loop_models(const std::string& material);
// Springs and dashpots, which come to rest within seconds. The material `silicone` creeps for minutes.
inline const std::vector<ModelPtr>& silicone_models() { return loop_models("maxwell"); }
inline const std::vector<ModelPtr>& stiff_models() { return loop_models("stiff"); }
inline constexpr const char* kMaterialsWithMemory[] = {"friction", "sponge", "layered"};

// A force and the approximate depth that it causes.
struct HandPress {
  double force_N = 0.0;
  double depth_m = 0.0;
};
inline constexpr HandPress kFirm{3.0, 5e-3};
inline constexpr HandPress kLight{0.3, 0.6e-3};
inline constexpr HandPress kFirmOnStiff{3.0, 1e-3};
// About half of the force and depth of the training.
HandPress half_press(const ModelPtr& model);

inline constexpr double kSoftSpring_N_per_m = 600.0;  // as silicone at 3 N
inline constexpr double kStiffSpring_N_per_m = 3000.0;
// The damping of a spring force that is held for a tick and one tick late; negative.
double held_and_late_Ns_per_m(double stiffness_N_per_m);

// Motion when the hand holds still, peak to peak. Drift, a straight line, is subtracted except in `span_m`.
struct Rest {
  double span_m = 0.0;  // of the position, with the drift
  double position_m = 0.0;
  double position_steps = 0.0;  // in encoder steps
  double force_jnd = 0.0;       // of the rendered force, in JND at the force of the press
  double given_J = 0.0;         // energy from the rendered force in that time
  double largest_N = 0.0;       // over the whole run
  double share = 1.0;           // rendered share of the stiffness, at the end

  void keep_worse(const Rest& other);
};

// Presses within 0.3 s, receives a pulse of 1 N for 20 ms at 0.6 s, and holds still.
// Measures the last `still_s` of `seconds`.
Rest hold(const ForcePtr& model, const ClosedLoopSettings& settings, const HandPress& press, double seconds,
          double still_s = 0.25);
// The worst result over both encoders and all values of Ticking, with one tick of delay.
Rest worst_hold(const ForcePtr& model, const Grip& grip, const HandPress& press, double seconds = 1.5);

// Closed cycles within the block along a sine of `amplitude_m` about `middle_m`.
// Returns the damping that absorbs the same energy per cycle,
//   b = (put in - got out) / (pi w A^2),
// the minimum over 2 to 40 Hz. At or above 0 no cycle generates energy.
double least_damping_Ns_per_m(const ForcePtr& model, double middle_m, double encoder_m, double amplitude_m,
                              Ticking ticking);
// The minimum over both encoders, amplitudes of 0.1 and 0.5 mm, even and uneven ticks.
double least_damping_Ns_per_m(const ForcePtr& model, double middle_m);

struct Strokes {
  double worst_return = 0.0;   // largest ratio of energy returned to energy put in, of one stroke
  double beyond_step_J = 0.0;  // largest surplus of returned energy beyond one encoder step times the largest force
  double own_beyond_step_J = -1.0;  // the same of one stroke and its own largest force
  double largest_cost_jnd = 0.0;    // of the force that the controller takes away, over the JND
  double mean_cost_jnd = 0.0;       // its mean in contact

  void keep_worse(const Strokes& other);
};

// Four strokes from the air and back into it, in 0.1 to 0.8 s.
Strokes stroke(const ForcePtr& model, const ClosedLoopSettings& settings, const HandPress& press);

// Prints "who: " and both numbers by the printf `format` as one line.
void say(const std::string& who, const char* format, double first, double second);

}  // namespace palpate::test
