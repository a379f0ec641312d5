// What is selected on materials of one cause each.
#include "models/training/feature_selection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

namespace palpate {
namespace {

constexpr double kRate_Hz = 200.0;

// Presses of different depth and speed, 12 s in all, with air between them.
double press_m(double t) {
  const int stroke = static_cast<int>(t);
  const double phase = t - stroke;
  const double depth_m = 3e-3 + 1e-3 * std::sin(1.7 * stroke);
  return depth_m * std::sin(3.14159265358979 * std::min(1.0, phase * (1.2 + 0.3 * std::cos(2.3 * stroke)))) - 0.2e-3;
}

using Force = std::function<double(double time_s, double position_m)>;

std::shared_ptr<Recording> recorded(const std::function<double(double)>& position_m, const Force& force_N) {
  auto recording = std::make_shared<Recording>();
  recording->name = "press";
  for (int i = 0; i < 12 * static_cast<int>(kRate_Hz); ++i) {
    RecordingRow row;
    row.time_s = i / kRate_Hz;
    row.position_m = position_m(row.time_s);
    const double noise_N = 2e-3 * std::sin(91.7 * i * i);
    row.force_N = std::max(0.0, force_N(row.time_s, row.position_m)) + noise_N;
    recording->rows.push_back(row);
  }
  return recording;
}

FeatureSelection selected(const std::shared_ptr<Recording>& recording, bool turns_round = true) {
  MotionSource source({{"", recording}});
  std::size_t contact = 0;
  int strokes = 0;
  (void)source.for_each([&](const MotionRow& row) {
    contact += row.sample.position_m > 0.0 ? 1 : 0;
    strokes = row.stroke;
    return true;
  });
  const FoldDealer dealer(1, static_cast<std::size_t>(strokes), contact, turns_round);
  SelectionInput input;
  input.reference_depth_m = 4e-3;
  input.rms_velocity_m_per_s = 5e-3;
  input.force_floor_N = 0.01;
  input.turns_round = turns_round;
  auto selection = select_features(source, dealer, input, {}, 0.0);
  EXPECT_TRUE(selection.ok());
  return selection ? *selection : FeatureSelection{};
}

TEST(FeatureSelection, ASpringNeedsTheDepthAlone) {
  const auto selection = selected(recorded(press_m, [](double, double x) { return 400.0 * std::max(0.0, x); }));
  EXPECT_FALSE(selection.list.velocity);
  EXPECT_TRUE(selection.list.relaxation_times_s.empty());
  EXPECT_TRUE(selection.list.stop_thresholds_m.empty());
  EXPECT_TRUE(selection.list.peak_times_s.empty());
  EXPECT_FALSE(selection.worth.empty()) << "what the others would be worth is told";
}

TEST(FeatureSelection, ABranchIsFoundWithItsTime) {
  double z = 0.0;
  double last = 0.0;
  const auto selection = selected(recorded(press_m, [&](double, double x) {
    const double d = std::max(0.0, x);
    const double e = std::exp(-1.0 / kRate_Hz / 0.2);
    z = e * z + 600.0 * 0.2 * (1.0 - e) * kRate_Hz * (d - last);
    last = d;
    return x > 0.0 ? 300.0 * d + z : 0.0;
  }));
  ASSERT_FALSE(selection.list.relaxation_times_s.empty());
  EXPECT_TRUE(selection.list.surface.empty()) << "this one follows the tool";
  EXPECT_EQ(selection.list.slowing, 0.0);
  double nearest = 1e9;
  for (const auto& group : selection.list.relaxation_times_s) {
    for (const double time_s : group) nearest = std::min(nearest, std::abs(std::log(time_s / 0.2)));
  }
  EXPECT_LT(nearest, std::log(10.0) / 4.0) << "one step of the ladder";
  EXPECT_TRUE(selection.list.stop_thresholds_m.empty());
}

// A spring of 300 N/m beside a branch of 900 N/m; where they would pull, the surface
// stays behind the tool at the depth at which they hold nothing.
TEST(FeatureSelection, ASurfaceThatLeavesTheToolIsFound) {
  double z = 0.0;
  double surface_m = 0.0;
  const double keep = std::exp(-1.0 / kRate_Hz / 0.2);
  const double gain = 900.0 * 0.2 * (1.0 - keep) * kRate_Hz;
  const auto selection = selected(recorded(press_m, [&](double, double x) {
    const double free_m = (gain * surface_m - keep * z) / (300.0 + gain);
    const double next_m = std::max({0.0, x, free_m});
    z = keep * z + gain * (next_m - surface_m);
    surface_m = next_m;
    return x >= free_m && x > 0.0 ? 300.0 * x + z : 0.0;
  }));
  EXPECT_FALSE(selection.list.surface.empty());
}

TEST(FeatureSelection, TimesThatGrowWithTheDepthAreFound) {
  double z = 0.0;
  double last_m = 0.0;
  const auto selection = selected(recorded(press_m, [&](double, double x) {
    const double d = std::max(0.0, x);
    const double time_s = 0.05 * std::exp(2.5 * 0.5 * (d + last_m) / 4e-3);
    const double e = std::exp(-1.0 / kRate_Hz / time_s);
    z = e * z + 600.0 * time_s * (1.0 - e) * kRate_Hz * (d - last_m);
    last_m = d;
    return x > 0.0 ? 300.0 * d + z : 0.0;
  }));
  EXPECT_NEAR(selection.list.slowing, 2.5, 1.0);
}

TEST(FeatureSelection, DryFrictionNeedsStops) {
  double s = 0.0;
  double last = 0.0;
  const auto selection = selected(recorded(press_m, [&](double, double x) {
    const double d = std::max(0.0, x);
    s = d > 0.0 ? std::clamp(s + d - last, -1e-4, 1e-4) : 0.0;
    last = d;
    return x > 0.0 ? 500.0 * d + 0.35 * s / 1e-4 * std::min(1.0, d / 2e-3) : 0.0;
  }));
  EXPECT_FALSE(selection.list.stop_thresholds_m.empty());
  for (const FeatureWorth& worth : selection.worth) {
    if (worth.name.rfind("stops", 0) != 0) continue;
    EXPECT_TRUE(worth.taken);
    EXPECT_GT(worth.error_without, 2.0 * worth.error_with);
  }
}

TEST(FeatureSelection, OneWayInGetsTheDepthAlone) {
  const auto selection = selected(recorded([](double t) { return 4e-3 * t / 12.0; },
                                           [](double t, double x) { return 400.0 * x + 0.2 * std::exp(-t); }),
                                  false);
  EXPECT_FALSE(selection.list.velocity);
  EXPECT_TRUE(selection.list.relaxation_times_s.empty());
  EXPECT_TRUE(selection.list.stop_thresholds_m.empty());
}

}  // namespace
}  // namespace palpate
