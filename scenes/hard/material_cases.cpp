// Motions unlike the training, and a hand in closed loop, on virtual materials with automatically selected features.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "engine/base/text.h"
#include "scenes/hard/hard_trials.h"
#include "scenes/material/material.h"
#include "scenes/material/rig.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

// Springs and dashpots, dry friction, a fluid in pores, and a stiff inclusion under 6 mm.
constexpr const char* kMotionMaterials[] = {"maxwell", "friction", "sponge", "layered"};
// Long enough to identify every feature.
constexpr double kMaterialSeconds = 12.0;
constexpr double kMaterialRate_Hz = 250.0;

// The training on each material, made when it is first needed, and its greatest depth.
class Trainings {
 public:
  struct One {
    std::shared_ptr<HardTraining> training;
    double depth_m = 0.0;
    double force_N = 0.0;
  };
  const One& of(const std::string& material) {
    One& one = made_[material];
    if (one.training) return one;
    RigSettings settings;
    settings.material = material;
    settings.seconds = kMaterialSeconds;
    settings.rate_Hz = kMaterialRate_Hz;
    Recording recording = std::move(*record_sensors(settings));
    for (const RecordingRow& row : recording.rows) {
      one.depth_m = std::max(one.depth_m, row.position_m);
      one.force_N = std::max(one.force_N, row.force_N);
    }
    const TrainingScene scene{
        "hard case",
        {{FeatureKind::depth, 0.0, {}}, {FeatureKind::velocity, 0.0, {}}, {FeatureKind::lowpass_velocity, 0.17, {}}},
        {}};
    one.training =
        std::make_shared<HardTraining>(ModelFits({prepare_recording(std::move(recording))}, scene), ModelPlan{});
    return one;
  }

 private:
  std::map<std::string, One> made_;
};
using TrainingsPointer = std::shared_ptr<Trainings>;

struct Motion {
  const char* name;
  const char* why;
  HardExpectation expected;
  Path (*path)(double size);  // `size`: greatest depth of the training over kTrainingDepth_m
  double seconds = 4.0;
};

Path usual(double size) { return scaled(training_path(1), size, 0.0); }

std::vector<Motion> motions() {
  const HardExpectation all{.within_jnd = 0.5, .worst_error_N = 10.0, .worst_step_N = 1.0, .energy_J = 1e-3};
  return {
      {"half as deep again", "the force beyond the recorded depth is not known", all,
       [](double size) { return scaled(usual(size), 1.5, 0.0); }},
      {"three times as fast", "", all,
       [](double size) -> Path { return [path = usual(size)](double t) { return path(3.0 * t); }; }},
      {"a hold ten times as long", "", all,
       [](double size) -> Path { return [=](double t) { return size * 0.004 * std::tanh(5.0 * t); }; }, 20.0},
      {"contact made and broken at 20 Hz", "", all,
       [](double size) -> Path {
         return [=](double t) { return size * 0.003 * std::sin(2.0 * std::numbers::pi * 20.0 * t); };
       }},
      {"a sudden stop", "", all,
       [](double size) -> Path { return [=](double t) { return size * 0.05 * std::min(t, 0.1); }; }, 1.0},
      {"deeper without end", "", all, [](double size) -> Path { return [=](double t) { return size * 0.05 * t; }; },
       2.0},
      {"small cycles at depth", "", all,
       [](double size) -> Path {
         return [=](double t) { return size * (0.004 + 0.0002 * std::sin(2.0 * std::numbers::pi * 7.0 * t)); };
       }},
  };
}

void add_motions(std::vector<HardCase>& cases, const TrainingsPointer& trainings) {
  for (const std::string material : kMotionMaterials) {
    for (const Motion& motion : motions()) {
      const auto build = [=] {
        const Trainings::One& one = trainings->of(material);
        const auto block = find_material(material)->make_block();
        const auto press = std::make_shared<const Press>(
            press_into(*block, motion.path(one.depth_m / kTrainingDepth_m), even_times(motion.seconds, 1000.0)));
        return HardTrial{one.training, [press](const auto& model) { return measure_press(*press, model); }};
      };
      cases.push_back({material + ": " + motion.name, HardKind::motion, motion.why, motion.expected, {}, build});
    }
  }
}

// A finger in light contact, and a clenched fist (closed_loop.h).
const Grip kLight{"a light hand", 0.05, 100.0, 2.2};
const Grip& heavy() { return grips()[2]; }

HardCase hand_case(const TrainingsPointer& trainings, const std::string& name, const std::string& why,
                   const HardExpectation& expected, const std::string& material, HandTrial trial, double press) {
  const auto build = [=] {
    const Trainings::One& one = trainings->of(material);
    HandTrial at = trial;
    at.depth_m = std::sqrt(press) * one.depth_m;
    at.force_N = press * one.force_N;
    if (at.exchange_s > 0.0) at.other = one.training->fit(*parse_plan("trend"), {})->model;
    return HardTrial{one.training, [=](const auto& model) {
                       const auto block = find_material(material)->make_block();
                       return measure_hand(at, *block, model);
                     }};
  };
  return {material + ": " + name, HardKind::loop, why, expected, {}, build};
}

void add_hands(std::vector<HardCase>& cases, const TrainingsPointer& trainings) {
  const HardExpectation all{.within_jnd = 0.5, .worst_error_N = 10.0, .worst_step_N = 1.0, .energy_J = 1e-3};
  struct Line {
    const char* name;
    double delay_s, sample_s;
  };
  constexpr Line kLines[] = {{"10 kHz, no delay", 0.0, 1e-4},  {"1 kHz, no delay", 0.0, 1e-3},
                             {"1 kHz, 3 ms late", 3e-3, 1e-3}, {"1 kHz, 10 ms late", 10e-3, 1e-3},
                             {"100 Hz, no delay", 0.0, 10e-3}, {"100 Hz, 10 ms late", 10e-3, 10e-3}};
  for (const char* material : {"maxwell", "stiff"}) {
    for (const Line& line : kLines) {
      for (const bool light : {true, false}) {
        LoopSettings settings{light ? kLight : heavy(), 10e-6, line.delay_s};
        settings.sample_s = line.sample_s;
        cases.push_back(hand_case(trainings, std::string(light ? "light hand, " : "heavy hand, ") + line.name, "", all,
                                  material, {settings}, 0.3));
      }
    }
  }
  for (const char* material : {"friction", "sponge", "layered"}) {
    for (const bool light : {true, false})
      cases.push_back(hand_case(trainings, std::string(light ? "light hand, " : "heavy hand, ") + "1 kHz, 1 ms late",
                                "", all, material, {{light ? kLight : heavy(), 10e-6, 1e-3}}, 0.3));
  }
  for (const char* material : {"maxwell", "stiff"}) {
    cases.push_back(hand_case(trainings, "a pressed mass is released", "nothing damps its motion", all, material,
                              {{mass_alone(), 10e-6, 1e-3}}, 0.3));
    HandTrial swap{{grips()[1], 10e-6, 1e-3}};
    swap.exchange_s = 0.1;
    cases.push_back(
        hand_case(trainings, "swap while pressing", "for the trend and back, every 100 ms", all, material, swap, 0.3));
  }
}

}  // namespace

std::vector<HardCase> material_cases() {
  const auto trainings = std::make_shared<Trainings>();
  std::vector<HardCase> cases;
  add_motions(cases, trainings);
  add_hands(cases, trainings);
  return cases;
}

}  // namespace palpate
