// Numerically hard data and motions far from the data: every method is tested on every case.
//
// Three kinds of case, all synthetic and deterministic:
//   sites       coinciding, clustered, flat and badly scaled points; as few as one; more centres than sites
//   recording   what sensors and hands do wrong: noise, drift, outliers, lost and jittered samples, extreme rates
//   motion      presses unlike the training, in every virtual material: deeper, faster, longer, abrupt
// A method must refuse a case with a message, or give only safe values: finite and bounded (sites: at most 1.2 times
// the range of the forces outside that range; else from 0 to 1.2 times the largest training force).
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "models/fit/fit.h"
#include "tests/support/press.h"

namespace palpate::test {

// One method in one case.
struct HardCase {
  std::string method;
  std::string refusal;                       // empty if the fit was accepted
  std::shared_ptr<const FittedModel> model;  // null for sites, or if refused
  // The values so far.
  std::size_t count = 0, unsafe = 0;
  std::size_t known = 0, within = 0;  // with a known true force, and of these within the JND of it
  double worst_over_jnd = 0.0;        // error

  // Adds a value, which is safe if it is finite and from `low_N` to `high_N`.
  void add(double value_N, double low_N, double high_N);
  void add(double value_N, double truth_N, double low_N, double high_N);
};

// Strokes of several depths and speeds with pauses between and on the way. `variant` changes their order and speed,
// not their range.
inline constexpr double kTrainingDepth_m = 6e-3;
Path training_path(int variant);
// offset + factor times the path.
Path scaled(const Path& path, double factor, double offset_m);

// Features: depth, velocity and a low-pass. The surface is as recorded, because these cases
// test numerics and not registration.
TrainingRequest clean_request();

// Each method fitted to this recording, in the order of methods().
std::vector<HardCase> fit_methods(const Recording& recording, const TrainingRequest& request);
// Adds the force of every model at every tick of `press` in contact.
void evaluate_press(const Press& press, std::vector<HardCase>& cases);

// Expects safe values or a refusal, and logs one line for each case.
void expect_safe(const std::string& name, const std::vector<HardCase>& cases);

}  // namespace palpate::test
