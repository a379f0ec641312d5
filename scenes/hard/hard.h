// The hard cases of `palpate hard`: numerically hard sites, faulty recordings, motions unlike the training, and a hand
// in closed loop. Each case has one training and a trial whose true force is known. Every method runs on every case,
// and what must hold is the same for all of them:
//   error    at least kWithin of the ticks in contact are within one JND of the true force, unless the case states a
//            physical reason why the force cannot be known
//   step     no step of the force above the largest step of the true force plus one JND
//   energy   the force gives out at most an encoder step times the largest true force
// A cell that misses one of them is broken. Which cells break today is recorded in assets/hard/cases.json; another
// break, or a fit that is refused, is not as expected. A method that is not recorded there may break anything.
//
// Everything is virtual and deterministic. Thread guarantee: slow side; fits start threads; pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/random_stream.h"
#include "engine/live/live_tick.h"
#include "models/fit/fit.h"
#include "scenes/material/material.h"
#include "scenes/report/publish.h"

namespace palpate {

inline constexpr const char* kHardKinds[] = {"sites", "recording", "motion", "loop"};

inline constexpr double kWithin = 0.99;
inline constexpr double kHardEncoder_m = 10e-6;  // of the device; a press of exact positions is judged with it, too

// What a cell can break, as bits, and their names.
enum HardBreak : unsigned { kBreaksError = 1, kBreaksStep = 2, kBreaksEnergy = 4 };
inline constexpr const char* kHardBreaks[] = {"error", "step", "energy"};

// The figures of one model in one trial; NaN: does not apply.
struct HardFigures {
  double within_jnd = kNotMeasured;     // share of the ticks in contact with an error within the JND of the true force
  double worst_error_N = kNotMeasured;  // of these ticks
  double worst_step_N = kNotMeasured;   // largest change of the force between neighbouring ticks
  // By how much a step exceeds the largest step of the true force plus one JND; negative: it does not.
  double step_over_N = kNotMeasured;
  // Energy that the force gave out beyond what the tool had put in, largest over time and beyond that of the material.
  double energy_J = kNotMeasured;
  double largest_N = 0.0;  // of the true force

  static constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
  unsigned breaks(bool error_counts) const;  // of HardBreak
};

// A column of the table: a plan with default options, or the negative control, the direct solve of the paper without
// truncation and regularisation: without a method that fails, a table that is passed says nothing.
struct HardMethod {
  std::string name;
  ModelPlan plan;
  bool untruncated = false;
};
// All methods on the measured force, the trend, the default, and the negative control.
std::vector<HardMethod> hard_methods();

// The fits to one training, each made when it is first asked for.
class HardTraining {
 public:
  // `common`: what all plans have in common beside base and method.
  HardTraining(ModelFits fits, ModelPlan common) : fits_(std::move(fits)), common_(std::move(common)) {}

  // Its `seconds` are with the preparation, if this fit was the first to need it. Errors: those of the fit;
  // interrupted.
  const Result<MethodFit>& fit(const HardMethod& method, const FitControl& control);

 private:
  Result<MethodFit> untruncated(const ModelPlan& plan, const FitControl& control);

  ModelFits fits_;
  ModelPlan common_;
  std::map<std::string, Result<MethodFit>> made_;  // by name
};

struct HardTrial {
  std::shared_ptr<HardTraining> training;
  // Pure, any thread.
  std::function<HardFigures(const std::shared_ptr<const FittedModel>&)> measure;
};

struct HardCase {
  std::string name;
  std::string kind{};  // of kHardKinds
  std::function<HardTrial()> build{};
  // From assets/hard/cases.json:
  std::string why{};      // what is hard
  std::string unknown{};  // the physical reason why the force cannot be known; empty: the error counts
  std::string refusal{};  // part of the reason; empty: the fit must be accepted
  std::map<std::string, unsigned> breaks{};  // by method, what breaks today; a method without an entry is not recorded
};

// Collects the figures of one model, tick by tick.
class HardMeasure {
 public:
  // `counts`: the tick is in contact. `position_m`: of the tool, for the energy; NaN: the energy does not count.
  void add(double force_N, double true_N, bool counts, double position_m = HardFigures::kNotMeasured);
  const HardFigures& figures() const { return figures_; }

 private:
  HardFigures figures_;
  std::size_t ticks_ = 0, counted_ = 0, within_ = 0;
  double beyond_jnd_N_ = 0.0, true_step_N_ = 0.0;  // largest step less the JND, largest step of the true force
  double last_m_ = HardFigures::kNotMeasured, last_N_ = 0.0, last_true_N_ = 0.0;
  double given_J_ = 0.0, truly_given_J_ = 0.0;
};

// The cases of each kind, in the order of the table, without what the file says. Motions and hands share the fits to
// each material.
std::vector<HardCase> site_cases();
std::vector<HardCase> recording_cases();
std::vector<HardCase> material_cases();

struct HardCell {
  MethodFit fit{};        // without a model: refused
  std::string refusal{};  // why
  HardFigures figures{};
  unsigned breaks = 0;
  std::string missed{};  // what is not as expected; empty: all is
};
struct HardRow {
  HardCase of;
  std::vector<HardCell> cells;  // in the order of hard_methods()
};

// What is not as expected in a cell with these breaks; empty: nothing.
std::string missed_by(const HardCell& cell, const HardCase& of, const std::string& method);

// Errors: interrupted.
Result<std::vector<HardRow>> run_hard(const FitControl& control = {});
// "voxel, repeated sites: ..." for each cell that is not as expected.
std::vector<std::string> missed_cells(const std::vector<HardRow>& rows);
// On how many cases each method is stable, which give out energy, how many cells are broken and how many of them are
// new.
std::string hard_answer(const std::vector<HardRow>& rows);
// One object for each cell, with every figure.
nlohmann::ordered_json hard_json(const std::vector<HardRow>& rows);
// A row for each case, of one kind or (empty) of all, and a column for each method: "✓ 99.8" or "✗ 45.1" is whether the
// cell is broken, and the percentage within the JND, or "refused"; with "!" where it is not as expected.
Table marks_table(const std::vector<HardRow>& rows, const std::string& kind = "");

// Writes the page, its tables and report.json into the folder `out`. Errors: those of ReportFolder and write_report.
Status write_hard_page(const std::vector<HardRow>& rows, const PageRequest& page, const FitControl& control = {});

// A tool in a hand, in closed loop with the live tick. Time is simulated; the same settings give bit-identical results.
//   m a = k (aim - x) + c (d aim/dt - v) + push - F
// at 20 kHz. In each tick LiveTick::run reads x in whole encoder steps and writes a force. F is that force, applied
// `delay_s` later and held until the next one.
struct Grip {
  std::string name;
  double mass_kg = 0.12;  // tool, handle and the moving part of the hand
  double stiffness_N_per_m = 800.0, damping_Ns_per_m = 14.0;
};

// From a light contact of a finger to a clenched fist: stiffness and damping rise
// together with the grip (Hajian & Howe 1997; Hasser & Cutkosky 2002), the damping is
// 0.5 to 0.7 of critical. `braced` is the hand of devices/virtual/simulated_devices.h.
// The last is a free mass without stiffness and damping.
inline const std::array<Grip, 4> kGrips{{{"relaxed", 0.08, 150.0, 3.5},
                                         {"braced", 0.12, 800.0, 14.0},
                                         {"clenched", 0.3, 2000.0, 30.0},
                                         {"mass alone", 0.1, 0.0, 0.0}}};
inline const Grip& mass_alone() { return kGrips.back(); }
inline bool held(const Grip& grip) { return grip.stiffness_N_per_m > 0.0; }

// The simulation has this many steps of time within the period of a tick, 1 ms.
inline constexpr std::int64_t kPeriodSteps = 20;

struct ClosedLoopSettings {
  Grip grip;
  double encoder_step_m = 30e-6;
  double delay_s = 1e-3;
  // Moves the deadline of the next tick, in steps, and returns the step of the tick; null: ticks are even.
  std::function<std::int64_t(std::int64_t& deadline)> uneven{};
  ForceLimits limits{10.0, 5000.0, 0.0};  // of a typical force-feedback device
  double sample_s = 0.0;                  // interval of the samples; 0: one sample in each tick
  // What a line does that DeviceHealth does not report.
  double jitter_s = 0.0;      // a force is up to this much later than `delay_s`, never before an earlier one
  std::uint64_t lost_in = 0;  // one in so many samples and forces is lost; 0: none
  int grouped = 1;            // so many samples arrive together
  ForceScale scale{};
};

// Energy between the tool and the rendered force, J: `put_in_J` by the tool while the
// force resists the motion, `got_out_J` by the force while it drives the motion.
struct LoopEnergy {
  double put_in_J = 0.0, got_out_J = 0.0;
  double balance_J() const { return put_in_J - got_out_J; }
};

class SimulatedTool final : public Device {
 public:
  explicit SimulatedTool(const ClosedLoopSettings& settings) : settings_(settings) {}

  const std::string& name() const noexcept override { return name_; }
  SensorSpec sensor() const noexcept override { return {.encoder_step_m = settings_.encoder_step_m}; }
  Holder holder() const noexcept override { return Holder::person; }
  ForceLimits limits() const noexcept override { return settings_.limits; }
  bool read(double now_s, DeviceSample& sample) noexcept override;
  void write(double force_N) noexcept override;
  // Reports the interval between samples, as DeviceEndpoint does.
  DeviceHealth health(double now_s) noexcept override;

  // One step of 50 us towards `aim_m`, which moves at `aim_m_per_s`.
  void advance(double aim_m, double aim_m_per_s, double push_N) noexcept;
  void place(double position_m, double velocity_m_per_s) noexcept;

  double time_s() const noexcept;
  double position_m() const noexcept { return position_m_; }
  double velocity_m_per_s() const noexcept { return velocity_m_per_s_; }
  double force_N() const noexcept { return acting_.force_N; }
  const LoopEnergy& energy() const noexcept { return energy_; }

 private:
  struct Written {
    double force_N = 0.0;
    std::int64_t sampled = 0;  // step of the sample from which it was computed
    std::int64_t due = 0;      // step at which it takes effect
  };

  ClosedLoopSettings settings_;
  std::string name_ = "simulated tool";
  std::int64_t step_ = 0, read_step_ = -1, sample_step_ = 0, newest_sample_ = 0, acted_from_ = 0;
  double position_m_ = -2e-3, velocity_m_per_s_ = 0.0;
  Written acting_;
  std::array<Written, 64> written_{};
  std::size_t first_ = 0, count_ = 0;
  RandomStream random_{7, 8};
  int sample_ = 0;
  LoopEnergy energy_;
};

// The loop: the tool, the tick, and its timing.
class ClosedLoop {
 public:
  struct Drive {
    double aim_m = 0.0, aim_m_per_s = 0.0;
    double push_N = 0.0;  // a force that does not depend on the position
  };
  using Path = std::function<Drive(double time_s)>;
  using AfterTick = std::function<void(const LoopSnapshot&)>;

  explicit ClosedLoop(const ClosedLoopSettings& settings);
  virtual ~ClosedLoop() = default;

  // Publishes a set of one model, which the next tick takes, with the memory of the motion so far.
  void publish(std::shared_ptr<const ForceModel> model);
  // Runs for `seconds`. The time of `path` starts at 0 with each call. `after_tick` may be empty.
  void run(double seconds, const Path& path, const AfterTick& after_tick = {});

  SimulatedTool& tool() { return tool_; }
  ModelSlot<LiveModels>& slot() { return slot_; }
  std::uint32_t faults() const { return faults_; }

 protected:
  // One tick; tests watch it.
  virtual const LoopSnapshot& tick() { return live_.run(tool_.time_s(), controls_); }

 private:
  SimulatedTool tool_;
  ModelSlot<LiveModels> slot_;
  LiveTick live_;
  MotionHistory history_;
  std::function<std::int64_t(std::int64_t& deadline)> uneven_;
  LoopControls controls_;
  std::int64_t step_ = 0, deadline_ = 0, due_ = 0;
  std::uint32_t id_ = 0, faults_ = 0;
};

// Minimum jerk from `from_m` to `to_m` within `duration_s`, then held.
ClosedLoop::Drive minimum_jerk(double from_m, double to_m, double duration_s, double time_s);

// The position of the tool, m, as a function of time, s: a path for motions that the hand of the rig does not make.
using Path = std::function<double(double time_s)>;

inline constexpr double kInAir_m = -2e-3;

// Strokes of several depths and speeds from the air, with pauses between and on the way. `variant` changes their order
// and speed, not their range.
inline constexpr double kTrainingDepth_m = 6e-3;
Path training_path(int variant);
Path scaled(const Path& path, double factor, double offset_m);

// Evenly spaced times from 0.
std::vector<double> even_times(double seconds, double rate_Hz);

struct PressSensors {
  double encoder_step_m = 0.0;  // 0: exact positions
  double force_noise_N = 0.005;
  std::uint64_t seed = 1;  // of the noise
};

struct Press {
  Recording recording;         // position and force
  std::vector<double> true_N;  // the material's own force, row by row
};

// Resets `block` and moves the tool along `path`. `times_s`: ascending.
Press press_into(Block& block, const Path& path, const std::vector<double>& times_s, const PressSensors& sensors = {});

// The fits to one recording, with automatically selected features.
std::shared_ptr<HardTraining> train_on(Recording recording);
// Replays a press through the tick and compares it with the true force. Energy counts if the press begins in the air.
HardFigures measure_press(const Press& press, const std::shared_ptr<const FittedModel>& model);

// Runs a hand in closed loop with this model. The true force is that of `block` along the path that the tool takes.
struct HandTrial {
  ClosedLoopSettings settings;
  double exchange_s = 0.0;  // above 0: exchanges the model with `other` that often
  double depth_m = 0.0;     // the aim of the press
  double force_N = 0.0;     // approximately there
  std::shared_ptr<const FittedModel> other{};
};
// Presses within 0.3 s, receives a pulse of 1 N at 0.6 s, holds still until 1.5 s, and returns to the air; a free mass
// is pushed with the force and let go at 1.5 s. Energy: given out while the hand holds still, or over the whole run if
// that is more.
HardFigures measure_hand(const HandTrial& trial, Block& block, const std::shared_ptr<const FittedModel>& model);

}  // namespace palpate
