// The closed loop (closed_loop_test.cpp) over materials with memory: friction, softening,
// a power law, a layer, a fluid. The features are those that the fit selects for each
// recording, e.g. stops and spectra of relaxation times. The log has one line for each
// material, model, hand, encoder and delay.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "tests/support/closed_loop_energy.h"
#include "tests/support/rt_guard.h"

namespace palpate::test {
namespace {

constexpr const char* kMaterials[] = {"friction", "softening", "sponge", "layered", "tissue"};

// The trend alone, all sites, a grid, and the default method. Fitted once.
const std::vector<ModelPtr>& models_of(const std::string& material) {
  static std::map<std::string, std::vector<ModelPtr>> fitted;
  std::vector<ModelPtr>& models = fitted[material];
  if (!models.empty()) return models;
  RigSettings settings = train_settings(material);
  settings.seconds = 12.0;
  settings.rate_Hz = 250.0;
  const PreparedTraining prepared = prepare({rig_recording(settings)}, default_request("silicone_block"));
  for (const char* method : {"trend", "direct", "voxel", "greedy"}) {
    models.push_back(fit(prepared, find_method(method)));
  }
  return models;
}

// About half of the force and depth of the training.
Press press_of(const ModelPtr& model) {
  return {0.4 * model->data().largest_force_N, 0.6 * model->data().trend.reference_depth_m};
}

std::string features_text(const ModelPtr& model) {
  std::string text;
  for (const FeatureSpec& spec : model->features()) text += (text.empty() ? "" : ", ") + feature_name(spec);
  return text;
}

// These are three to ten times as stiff as the silicone of closed_loop_test.cpp (2 kN/m, and
// 7 kN/m before friction slips), so that a held and late force needs 3 to 10 N s/m of
// damping. A firm hand has that much and feels at most the encoder step. A relaxed finger has
// 3.5 N s/m and feels a buzz that neither grows nor ends. Measured with 1 and 3 ms of delay:
// firm 0.97 JND, on friction 2.96 JND; relaxed 10.4 JND and 0.82 mm, but below 1 JND on tissue
// and softening foam with 1 ms. Known limitation: the sponge has an instantaneous stiffness of
// 3.3 kN/m. With 3 ms of delay a relaxed finger on it oscillates by 4.2 mm, 21 JND; with 1 ms
// by 1.1 JND.
constexpr double kFirmStill_jnd = 1.2;
constexpr double kFirmOnFriction_jnd = 4.0;
constexpr double kRelaxedBuzz_jnd = 12.0;
constexpr double kRelaxedBuzz_m = 1.2e-3;
constexpr double kLateOnSponge_jnd = 25.0;
constexpr double kLateOnSponge_m = 5e-3;

TEST(ClosedLoop, ComesToRestOnMaterialsWithMemory) {
  for (const char* material : kMaterials) {
    std::printf("%s: %s\n", material, features_text(models_of(material).front()).c_str());
    for (const ModelPtr& model : models_of(material)) {
      for (const Grip& grip : grips()) {
        if (!held(grip)) continue;
        for (const double encoder_m : kEncoders_m) {
          for (const double delay_s : {1e-3, 3e-3}) {
            const Rest rest = hold(model, {grip, encoder_m, delay_s, Ticking::gaps}, press_of(model), 3.0);
            const std::string row = std::string(material) + " " + model->name() + " " + grip.name + " " +
                                    std::to_string(std::lround(1e6 * encoder_m)) + " um " +
                                    std::to_string(std::lround(1e3 * delay_s)) + " ms";
            say("at rest, " + row, "%.2f encoder steps, %.2f JND peak to peak", rest.position_steps, rest.force_jnd);
            const bool relaxed = grip.name == "relaxed";
            const bool thrown = relaxed && std::string(material) == "sponge" && delay_s > kOneTick_s;
            const double firm_jnd = std::string(material) == "friction" ? kFirmOnFriction_jnd : kFirmStill_jnd;
            const double relaxed_jnd = thrown ? kLateOnSponge_jnd : kRelaxedBuzz_jnd;
            const double relaxed_m = thrown ? kLateOnSponge_m : kRelaxedBuzz_m;
            EXPECT_LE(rest.force_jnd, relaxed ? relaxed_jnd : firm_jnd) << row;
            EXPECT_LE(rest.position_m, relaxed ? relaxed_m : 0.1e-3) << row;
            EXPECT_LE(rest.largest_N, 1.2 * model->data().largest_force_N) << row;
          }
        }
      }
    }
  }
}

// The limit of the others is that of closed_loop_energy_test.cpp; measured: 0.95. Known
// limitation: the sponge (17 N at 3.3 kN/m) returns up to 106 % of the energy of a stroke and
// a surplus of up to 6.8 mJ. The controller, limited to 12 N s/m, cannot dissipate that
// within 50 ms.
constexpr double kReturnOnSponge = 1.25;
constexpr double kGivenOnSponge_J = 0.01;

TEST(ClosedLoop, StrokesIntoMaterialsWithMemoryGiveLessThanTheyTake) {
  for (const char* material : kMaterials) {
    for (const ModelPtr& model : models_of(material)) {
      double worst_return = 0.0, cost_jnd = 0.0;
      for (const Grip& grip : grips()) {
        if (!held(grip)) continue;
        for (const double encoder_m : kEncoders_m) {
          const Strokes strokes = stroke(model, {grip, encoder_m, kOneTick_s, Ticking::gaps}, press_of(model));
          worst_return = std::max(worst_return, strokes.worst_return);
          cost_jnd = std::max(cost_jnd, strokes.mean_cost_jnd);
          const bool sponge = std::string(material) == "sponge";
          EXPECT_GE(strokes.lowest_J, sponge ? -kGivenOnSponge_J : -encoder_m * strokes.largest_N)
              << material << ", " << model->name() << ", " << grip.name;
        }
      }
      say(std::string("strokes, ") + material + " " + model->name(),
          "%.1f %% comes out again, passivity costs %.3f JND on the mean", 100.0 * worst_return, cost_jnd);
      EXPECT_LE(worst_return, std::string(material) == "sponge" ? kReturnOnSponge : 1.0)
          << material << ", " << model->name();
      EXPECT_LE(cost_jnd, 1.0) << material << ", " << model->name();
    }
  }
}

// A held and late force of up to 4 kN/m acts like -6 N s/m of damping. With the controller
// it lacks less than the 3.5 N s/m of a relaxed finger. Measured: -1.65 (sponge), -0.62
// (layered) to 2.3 (friction).
constexpr double kMostLacking_Ns_per_m = 2.0;

TEST(ClosedLoop, CyclesInMaterialsWithMemoryGiveLessThanAFingerTakes) {
  for (const char* material : kMaterials) {
    for (const ModelPtr& model : models_of(material)) {
      const double middle_m = press_of(model).depth_m;
      const double alone = least_damping_Ns_per_m(model, middle_m, false);
      const double least = least_damping_Ns_per_m(model, middle_m);
      say(std::string("cycles, ") + material + " " + model->name(),
          "damping of %.2f N s/m or more by itself, %.2f with the controller", alone, least);
      EXPECT_GE(least, -kMostLacking_Ns_per_m) << material << ", " << model->name();
    }
  }
}

// Exchanges two materials in mid-press, a hundred times a second. Memory that both have
// continues, other memory starts at rest, and nothing allocates.
TEST(ClosedLoop, MaterialsExchangedInMidPressStayBounded) {
  const Grip grip = grips()[1];
  ClosedLoop loop({grip, 30e-6, kOneTick_s, Ticking::gaps});
  std::vector<ModelPtr> models;
  for (const char* material : kMaterials) models.push_back(models_of(material).back());
  double largest_N = 0.0;
  for (const ModelPtr& model : models) largest_N = std::max(largest_N, 1.2 * model->data().largest_force_N);
  loop.publish(models.front());
  std::size_t published = 0;
  loop.run(
      3.0, [](double time_s) { return minimum_jerk(-2e-3, 6e-3, 0.3, time_s); },
      [&](const LoopSnapshot& snapshot) {
        EXPECT_TRUE(std::isfinite(snapshot.rendered_N));
        EXPECT_LE(snapshot.rendered_N, largest_N);
        if (snapshot.loop_time_s < 0.5 + 0.01 * static_cast<double>(published)) return;
        loop.publish(models[++published % models.size()]);
      });
  EXPECT_GT(published, 200U);
  EXPECT_EQ(loop.faults() & loop_fault::kStops, 0U);
  if (rt_guard_works()) {
    EXPECT_EQ(loop.offences(), 0);
  }
  // Back in the air the force is zero.
  loop.run(1.0, [](double time_s) { return minimum_jerk(6e-3, -5e-3, 0.3, time_s); });
  EXPECT_EQ(loop.tool().force_N(), 0.0);
}

}  // namespace
}  // namespace palpate::test
