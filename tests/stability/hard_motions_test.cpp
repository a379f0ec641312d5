// The motions of hard_cases.h in every virtual material.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "scenes/material/material.h"
#include "tests/stability/hard_cases.h"
#include "tests/support/example_model.h"
#include "tests/support/fitting.h"

namespace palpate::test {
namespace {

// Recordings of materials: long enough to identify every feature.
constexpr double kMaterialSeconds = 12.0;
constexpr double kMaterialRate_Hz = 250.0;
constexpr double kEvaluatedRate_Hz = 1000.0;

struct MotionCase {
  std::string name;
  Path path;
  double seconds = 4.0;
};

// Motions unlike a training with the greatest depth `depth_m`.
std::vector<MotionCase> motion_cases(double depth_m) {
  const double size = depth_m / kTrainingDepth_m;
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
void sweep(const FittedModel& model, HardCase& one) {
  const ModelData& data = model.data();
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t axis = 0; axis < data.features.size(); ++axis) {
    std::vector<double> x(data.offset.begin(), data.offset.end());
    const auto look = [&](double value) {
      x[axis] = value;
      one.add(model.evaluate(x.data()).force_N, 0.0, kForceMargin * data.largest_force_N);
    };
    for (const double sign : {-1.0, 1.0}) {
      for (double away = 1e-320; away < 1e308; away *= 3.0) look(sign * away);
      look(sign * infinity);
    }
    look(std::numeric_limits<double>::quiet_NaN());
  }
}

// Weights (or grid values) that overflow every sum.
ModelData with_huge_weights(ModelData data) {
  const auto overflow = [](auto& values) {
    for (auto i = values.size(); i-- > 0;) values[i] = i % 2 == 0 ? 1e300 : -1e300;
  };
  if (rbf_of(data.correction) != nullptr) change_rbf(data, [&](RbfFunction& rbf) { overflow(rbf.weights); });
  if (grid_of(data.correction) != nullptr) change_grid(data, [&](VoxelGrid& grid) { overflow(grid.values_N); });
  return data;
}

// Materials with friction, softening, layers and fluids, with automatically selected features.
TEST(HardCases, EveryMethodIsSafeInEveryMaterial) {
  std::set<std::string> corrected;  // methods with a correction in any material
  for (const Material& material : materials()) {
    const std::string name(material.name);
    RigSettings settings = train_settings(name);
    settings.seconds = kMaterialSeconds;
    settings.rate_Hz = kMaterialRate_Hz;
    const RecordingPtr recording = rig_recording(settings);
    TrainingRequest request = clean_request();
    request.choice = FeatureChoice::automatic;
    const std::vector<HardCase> fitted = fit_methods(*recording, request);

    double deepest_m = 0.0;
    for (const RecordingRow& row : recording->rows) deepest_m = std::max(deepest_m, row.position_m);
    const std::unique_ptr<Block> block = material.make_block();
    for (const MotionCase& motion : motion_cases(deepest_m)) {
      std::vector<HardCase> cases = fitted;
      evaluate_press(press_into(*block, motion.path, even_times(motion.seconds, kEvaluatedRate_Hz)), cases);
      expect_safe(name + ", " + motion.name, cases);
    }
    std::vector<HardCase> cases = fitted;
    for (HardCase& one : cases) {
      if (one.model == nullptr) continue;
      sweep(*one.model, one);
      if (!one.model->data().correction) continue;
      corrected.insert(one.method);
      sweep(FittedModel(with_huge_weights(one.model->data())), one);
    }
    expect_safe(name + ", to infinity on every axis", cases);
  }
  EXPECT_EQ(corrected.size(), methods().size() - 1) << "every method but the trend";
}

}  // namespace
}  // namespace palpate::test
