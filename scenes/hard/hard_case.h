// The hard cases of `palpate hard`: numerically hard sites, faulty recordings, motions unlike the training, and a hand
// in closed loop. Each case has one training, a trial whose true force is known, and an expectation. hard_table.h runs
// every method on every case.
//
// Everything is virtual and deterministic. Thread guarantee: slow side.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "models/fit/fit.h"

namespace palpate {

enum class HardKind : std::uint8_t { sites, recording, motion, loop };
inline constexpr const char* kHardKinds[] = {"sites", "recording", "motion", "loop"};  // their names

// The figures of one model in one trial; NaN: does not apply.
struct HardFigures {
  double within_jnd = kNotMeasured;     // share of the ticks in contact with an error within the JND of the true force
  double worst_error_N = kNotMeasured;  // of these ticks
  double worst_step_N = kNotMeasured;   // largest change of the force between neighbouring ticks
  // Energy that the force gave out beyond what the tool had put in, largest over time and beyond that of the material.
  double energy_J = kNotMeasured;

  static constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();
};

// What must hold for every figure that applies. A refusal counts only where it is expected.
struct HardExpectation {
  double within_jnd = 0.0;      // at least
  double worst_error_N = kAny;  // at most, and so on
  double worst_step_N = kAny, energy_J = kAny;
  std::string refusal{};  // part of the reason; empty: the fit must be accepted

  static constexpr double kAny = std::numeric_limits<double>::infinity();
};

// The fits to one training, each made when it is first asked for.
class HardTraining {
 public:
  // `common`: what all plans have in common beside base and method.
  HardTraining(ModelFits fits, ModelPlan common) : fits_(std::move(fits)), common_(std::move(common)) {}

  struct Fit {
    std::shared_ptr<const FittedModel> model;  // null: refused
    std::string refusal;
    Eigen::Index rank = 0;  // as MethodFit
    double condition_number = 0.0;
    double seconds = 0.0;  // with the preparation, if this fit was the first to need it
  };
  // The method of `plan` with default options. Errors: interrupted.
  Result<Fit> fit(const ModelPlan& plan, const FitControl& control);

 private:
  ModelFits fits_;
  ModelPlan common_;
  std::map<std::string, Fit> made_;  // by the name of the plan
};

struct HardTrial {
  std::shared_ptr<HardTraining> training;
  // Pure, any thread.
  std::function<HardFigures(const std::shared_ptr<const FittedModel>&)> measure;
};

struct HardCase {
  std::string name;
  HardKind kind = HardKind::sites;
  std::function<HardTrial()> build;
  std::string why{};  // what is hard, and where the expectation comes from
  // By the name of the plan; "force" (the methods on the measured force), "trend" and "corrected" for all others.
  std::map<std::string, HardExpectation> expected{};

  const HardExpectation& expectation(const ModelPlan& plan) const;
};

// Collects the figures of one model, tick by tick.
class HardMeasure {
 public:
  // `counts`: the tick is in contact. `position_m`: of the tool, for the energy; NaN: the energy does not count.
  void add(double force_N, double true_N, bool counts, double position_m = HardFigures::kNotMeasured);
  HardFigures figures() const;

 private:
  std::size_t ticks_ = 0, counted_ = 0, within_ = 0;
  double worst_N_ = 0.0, step_N_ = 0.0, last_N_ = 0.0;
  double last_m_ = HardFigures::kNotMeasured, last_true_N_ = 0.0;
  double given_J_ = 0.0, truly_given_J_ = 0.0, energy_J_ = 0.0;
};

// The cases of each kind, in the order of the table, without reason and expectation.
std::vector<HardCase> site_cases();
std::vector<HardCase> recording_cases();
// Motions and hands share the fits to each material.
std::vector<HardCase> material_cases();

// All cases. Reasons and expectations are those of assets/hard/cases.json: a list of within_jnd, worst_error_N,
// worst_step_N and energy_J, where null or a missing number is no limit, or the reason of a refusal. Errors: the file
// cannot be read, is no JSON or lacks a case.
Result<std::vector<HardCase>> hard_cases();

}  // namespace palpate
