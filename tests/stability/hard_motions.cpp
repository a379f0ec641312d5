// The motion cases of hard_cases.h, in the closed form and in every virtual material.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "scenes/material/rig.h"
#include "tests/stability/hard_cases.h"
#include "tests/stability/hard_methods.h"
#include "tests/stability/hard_outcome.h"
#include "tests/stability/hard_presses.h"
#include "tests/support/example_model.h"

namespace palpate {
namespace {

using ModelPtr = std::shared_ptr<const FittedModel>;

// Recordings of materials: long enough to identify every feature.
constexpr double kMaterialSeconds = 12.0;
constexpr double kMaterialRate_Hz = 250.0;
constexpr double kClosedFormDepth_m = 6e-3;

struct MotionCase {
  std::string name;
  Path path;
  double seconds = kEvaluatedSeconds;
};

// Motions unlike a training with the greatest depth `depth_m`.
std::vector<MotionCase> motion_cases(double depth_m) {
  const double size = depth_m / kClosedFormDepth_m;
  const Path usual = scaled(training_path(1), size, 0.0);
  const double stop_s = 0.1;
  return {
      {"half as deep again", scaled(usual, 1.5, 0.0)},
      {"three times as fast", [=](double t) { return usual(3.0 * t); }},
      {"a hold ten times as long", [=](double t) { return size * 0.004 * std::tanh(5.0 * t); }, 20.0},
      {"contact made and broken at 20 Hz", [=](double t) { return size * 0.003 * std::sin(2.0 * M_PI * 20.0 * t); }},
      {"a sudden stop", [=](double t) { return size * 0.05 * std::min(t, stop_s); }, 1.0},
      {"deeper without end", [=](double t) { return size * 0.05 * t; }, 10.0},
      {"small cycles at depth", [=](double t) { return size * (0.004 + 0.0002 * std::sin(2.0 * M_PI * 7.0 * t)); }},
  };
}

// Evaluates the model along every feature axis up to the largest doubles, infinity and NaN.
OutcomeCounter sweep(const FittedModel& model) {
  OutcomeCounter counter;
  const ModelData& data = model.data();
  const double highest_N = kForceMargin * data.largest_force_N;
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < data.features.size(); ++axis) {
    std::vector<double> x(data.offset.begin(), data.offset.end());
    const auto look = [&](double value) {
      x[axis] = value;
      counter.add_bounded(model.evaluate(x.data()).force_N, 0.0, highest_N);
    };
    for (const double sign : {-1.0, 1.0}) {
      for (double away = 1e-320; away < 1e308; away *= 3.0) look(sign * away);
      look(sign * infinity);
    }
    look(std::numeric_limits<double>::quiet_NaN());
  }
  return counter;
}

// Weights (or grid values) that overflow every sum.
ModelData with_huge_weights(ModelData data) {
  const auto overflow = [](auto& values) {
    for (auto i = values.size(); i-- > 0;) values[i] = i % 2 == 0 ? 1e300 : -1e300;
  };
  if (rbf_of(data.correction) != nullptr) test::change_rbf(data, [&](RbfFunction& rbf) { overflow(rbf.weights); });
  if (grid_of(data.correction) != nullptr) test::change_grid(data, [&](VoxelGrid& grid) { overflow(grid.values_N); });
  return data;
}

void add(std::vector<HardCaseResult>& results, const std::string& name, std::vector<HardCaseResult> more) {
  for (HardCaseResult& result : more) {
    result.name = name;
    results.push_back(std::move(result));
  }
}

double deepest_m(const Recording& recording) {
  double deepest = 0.0;
  for (const RecordingRow& row : recording.rows) deepest = std::max(deepest, row.position_m);
  return deepest;
}

}  // namespace

std::vector<HardCaseResult> run_hard_motions() {
  const FittedMethods fitted = fit_methods("clean training", clean_training().recording, clean_request());
  if (fitted.models.size() < methods().size()) return fitted.results;
  std::vector<HardCaseResult> results;
  for (const MotionCase& one : motion_cases(kClosedFormDepth_m)) {
    std::vector<OutcomeCounter> counters(fitted.models.size());
    evaluate_press(press_along(one.path, even_times(one.seconds, kEvaluatedRate_Hz)), fitted.models, counters);
    add(results, one.name, fitted.finish(counters));
  }
  for (const bool huge : {false, true}) {
    std::vector<OutcomeCounter> counters;
    for (const ModelPtr& model : fitted.models) {
      counters.push_back(sweep(huge ? FittedModel(with_huge_weights(model->data())) : *model));
    }
    add(results, huge ? "weights of 1e300, to infinity on every axis" : "to infinity on every axis",
        fitted.finish(counters));
  }
  return results;
}

std::vector<HardCaseResult> run_hard_materials() {
  std::vector<HardCaseResult> results;
  for (const Material& material : materials()) {
    const std::string name(material.name);
    RigSettings settings;
    settings.material = name;
    settings.seconds = kMaterialSeconds;
    settings.rate_Hz = kMaterialRate_Hz;
    const Result<Recording> rig = record_sensors(settings);
    if (!rig) return {refused({}, rig.error().message)};
    TrainingRequest request = clean_request();
    request.choice = FeatureChoice::automatic;
    const FittedMethods fitted = fit_methods(name, *rig, request);
    for (const MotionCase& one : motion_cases(deepest_m(*rig))) {
      const std::unique_ptr<Block> block = material.make_block();
      std::vector<OutcomeCounter> counters(fitted.models.size());
      evaluate_press(press_into(*block, one.path, even_times(one.seconds, kEvaluatedRate_Hz)), fitted.models, counters);
      add(results, name + ", " + one.name, fitted.finish(counters));
    }
    std::vector<OutcomeCounter> counters;
    for (const ModelPtr& model : fitted.models) counters.push_back(sweep(*model));
    add(results, name + ", to infinity on every axis", fitted.finish(counters));
  }
  return results;
}

}  // namespace palpate
