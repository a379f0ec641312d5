// Motions unlike the training, and a hand in closed loop, on virtual materials with automatically selected features.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>

#include "scenes/hard/hard_trials.h"
#include "scenes/material/material.h"
#include "scenes/material/rig.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

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
  Path (*path)(double size);  // `size`: greatest depth of the training over kTrainingDepth_m
  double seconds = 4.0;
};

Path usual(double size) { return scaled(training_path(1), size, 0.0); }

constexpr double kSlow_m_per_s = 0.05;  // of the sudden stop and of the endless press, at the size of the training

const Motion kMotions[] = {
    {"half as deep again", "the force beyond the recorded depth is not known",
     [](double size) { return scaled(usual(size), 1.5, 0.0); }},
    {"three times as fast", "faster than most of the training",
     [](double size) -> Path { return [path = usual(size)](double t) { return path(3.0 * t); }; }},
    {"a hold ten times as long", "20 s, longer than the training",
     [](double size) -> Path { return [=](double t) { return size * 0.004 * std::tanh(5.0 * t); }; }, 20.0},
    {"contact made and broken at 20 Hz", "ten times as fast as the training",
     [](double size) -> Path {
       return [=](double t) { return size * 0.003 * std::sin(2.0 * std::numbers::pi * 20.0 * t); };
     }},
    {"a sudden stop", "from full speed within a tick",
     [](double size) -> Path { return [=](double t) { return size * kSlow_m_per_s * std::min(t, 0.1); }; }, 1.0},
    {"deeper without end", "to three times the recorded depth, where the force is limited",
     [](double size) -> Path { return [=](double t) { return size * kSlow_m_per_s * t; }; }, 0.36},
    {"small cycles at depth", "0.2 mm at 7 Hz",
     [](double size) -> Path {
       return [=](double t) {
         return minimum_jerk(kInAir_m, size * 0.004, 0.4, t).aim_m +
                size * 0.0002 * std::sin(2.0 * std::numbers::pi * 7.0 * t);
       };
     }},
};

constexpr double kAny = HardExpectation::kAny;
// What the sensors hide: a largest force of 3 N over an encoder step of 30 um.
constexpr double kNone_J = 1e-4;

// What is expected of every motion in a material, in the order of kMotions.
struct MaterialMotions {
  const char* material;
  std::array<HardExpectations, std::size(kMotions)> expected;
};

const std::vector<MaterialMotions>& motion_materials() {
  static const std::vector<MaterialMotions> all{
      // Springs and dashpots.
      {"maxwell",
       {{
           {{0.3, 8, 0.2, kNone_J}, {0.5, 6, 0.15, kNone_J}, {0.5, 6, 0.15, kNone_J}},         // half as deep again
           {{0.9, 0.5, 0.25, kNone_J}, {0.98, 0.1, 0.2, kNone_J}, {0.98, 0.1, 0.2, kNone_J}},  // three times as fast
           {{0.98, 0.15, 0.2, kNone_J},
            {0.98, 0.1, 0.025, kNone_J},
            {0.98, 0.08, 0.06, kNone_J}},  // a hold ten times as long
           {{0.15, 4, 5, kNone_J},
            {0.45, 1.5, 1, kNone_J},
            {0.45, 1.5, 1, kNone_J},
            {{"kdtree-100", {0.05, 4, 4, kNone_J}}}},  // contact made and broken at 20 Hz
           {{0.9, 0.8, 1.5, kNone_J}, {0.98, 0.8, 1.5, kNone_J}, {0.98, 0.8, 1.5, kNone_J}},  // a sudden stop
           {{0, kAny, 0.2, kNone_J}, {0, kAny, 0.15, kNone_J}, {0, kAny, 0.15, kNone_J}},     // deeper without end
           {{0.9, 0.4, 0.25, kNone_J},
            {0.95, 0.25, 0.2, kNone_J},
            {0.95, 0.25, 0.2, kNone_J}},  // small cycles at depth
       }}},
      // Dry friction.
      {"friction",
       {{
           {{0.25, 4, 0.25, kNone_J}, {0.4, 4, 0.25, kNone_J}, {0.4, 4, 0.25, kNone_J}},  // half as deep again
           {{0.65, 0.8, 0.1, kNone_J},
            {0.98, 0.2, 0.15, kNone_J},
            {0.98, 0.2, 0.15, kNone_J},
            {{"kdtree-100", {0.7, 2.5, 0.25, kNone_J}}}},  // three times as fast
           {{0, 1, 0.2, kNone_J},
            {0.98, 0.2, 0.015, kNone_J},
            {0.98, 0.2, 0.015, kNone_J}},  // a hold ten times as long
           {{0.05, 2.5, 2.5, kNone_J},
            {0.9, 0.4, 1, kNone_J},
            {0.9, 0.4, 1, kNone_J},
            {{"kdtree-100", {0, 6, 6, 0.15}}}},  // contact made and broken at 20 Hz
           {{0.35, 0.8, 0.25, kNone_J},
            {0.98, 0.15, 0.25, kNone_J},
            {0.98, 0.15, 0.25, kNone_J},
            {{"kdtree-100", {0.4, 2, 1, kNone_J}}}},                                            // a sudden stop
           {{0, kAny, 0.15, kNone_J}, {0, kAny, 0.1, kNone_J}, {0, kAny, 0.1, kNone_J}},        // deeper without end
           {{0.25, 1.2, 0.25, kNone_J}, {0.9, 0.25, 0.2, kNone_J}, {0.9, 0.25, 0.2, kNone_J}},  // small cycles at depth
       }}},
      // A fluid in pores.
      {"sponge",
       {{
           {{0.15, 80, 1, kNone_J},
            {0.15, 80, 0.6, kNone_J},
            {0.15, 80, 0.6, kNone_J},
            {{"kdtree-100", {0.15, 80, 4, kNone_J}}}},  // half as deep again
           {{0.2, 25, 1.5, kNone_J},
            {0.2, 25, 1.5, kNone_J},
            {0.2, 25, 1.5, kNone_J},
            {{"kdtree-100", {0.3, 25, 5, kNone_J}}}},  // three times as fast
           {{0, 5, 0.8, kNone_J},
            {0.2, 2, 0.25, kNone_J},
            {0.15, 2, 0.25, kNone_J},
            {{"kdtree-100", {0, 4, 2.5, kNone_J}}}},  // a hold ten times as long
           {{0, 30, 30, 0.05},
            {0.7, 2, 5, kNone_J},
            {0.75, 2, 5, kNone_J},
            {{"kdtree-100", {0.1, 30, 30, 20}}}},  // contact made and broken at 20 Hz
           {{0, 20, 1, kNone_J},
            {0, 20, 0.6, kNone_J},
            {0, 20, 0.6, kNone_J},
            {{"kdtree-100", {0, 20, 4, kNone_J}}}},  // a sudden stop
           {{0, kAny, 1, kNone_J},
            {0, kAny, 0.6, kNone_J},
            {0, kAny, 0.6, kNone_J},
            {{"kdtree-100", {0, kAny, 4, kNone_J}}}},  // deeper without end
           {{0, 8, 1, kNone_J},
            {0, 4, 0.6, kNone_J},
            {0, 4, 0.6, kNone_J},
            {{"kdtree-100", {0, 8, 2.5, kNone_J}}}},  // small cycles at depth
       }}},
      // A stiff inclusion at 6 mm.
      {"layered",
       {{
           {{0.25, 15, 0.3, kNone_J}, {0.35, 15, 0.25, kNone_J}, {0.35, 15, 0.3, kNone_J}},  // half as deep again
           {{0.85, 0.6, 0.25, kNone_J},
            {0.98, 0.4, 0.25, kNone_J},
            {0.98, 0.25, 0.25, kNone_J}},  // three times as fast
           {{0, 0.4, 0.015, kNone_J},
            {0.98, 0.2, 0.015, kNone_J},
            {0.98, 0.1, 0.01, kNone_J}},  // a hold ten times as long
           {{0.15, 2.5, 2.5, 0.01},
            {0.9, 0.2, 0.25, kNone_J},
            {0.9, 0.2, 0.25, kNone_J}},  // contact made and broken at 20 Hz
           {{0.9, 0.5, 0.25, kNone_J},
            {0.9, 0.4, 0.25, kNone_J},
            {0.98, 0.15, 0.25, kNone_J},
            {{"kdtree-100", {0.85, 0.8, 1.5, kNone_J}}}},                                      // a sudden stop
           {{0, kAny, 0.3, kNone_J}, {0, kAny, 0.3, kNone_J}, {0, kAny, 0.3, kNone_J}},        // deeper without end
           {{0, 0.6, 0.15, kNone_J}, {0.9, 0.25, 0.15, kNone_J}, {0.9, 0.25, 0.15, kNone_J}},  // small cycles at depth
       }}},
  };
  return all;
}

void add_motions(std::vector<HardCase>& cases, const TrainingsPointer& trainings) {
  for (const MaterialMotions& in : motion_materials()) {
    for (std::size_t i = 0; i < std::size(kMotions); ++i) {
      const auto build = [trainings, material = std::string(in.material), motion = kMotions[i]] {
        const Trainings::One& one = trainings->of(material);
        const auto block = find_material(material)->make_block();
        const auto press = std::make_shared<const Press>(
            press_into(*block, motion.path(one.depth_m / kTrainingDepth_m), even_times(motion.seconds, 1000.0)));
        return HardTrial{one.training, [press](const auto& model) { return measure_press(*press, model); }};
      };
      cases.push_back({std::string(in.material) + ": " + kMotions[i].name, HardKind::motion, kMotions[i].why,
                       in.expected[i], build});
    }
  }
}

// A finger in light contact, and a clenched fist (closed_loop.h).
const Grip kLight{"a light hand", 0.05, 100.0, 2.2};
const Grip& heavy() { return grips()[2]; }
constexpr const char* kHands[] = {"light hand, ", "heavy hand, "};
constexpr double kEncoder_m = 10e-6;
constexpr double kPress = 0.3;  // of the largest force of the training

HardCase hand_case(const TrainingsPointer& trainings, const std::string& name, const std::string& why,
                   const HardExpectations& expected, const std::string& material, const HandTrial& trial) {
  const auto build = [=] {
    const Trainings::One& one = trainings->of(material);
    HandTrial at = trial;
    at.depth_m = std::sqrt(kPress) * one.depth_m;
    at.force_N = kPress * one.force_N;
    if (at.exchange_s > 0.0) at.other = one.training->fit(*parse_plan("trend"), {})->model;
    return HardTrial{one.training, [=](const auto& model) {
                       const auto block = find_material(material)->make_block();
                       return measure_hand(at, *block, model);
                     }};
  };
  return {material + ": " + name, HardKind::loop, why, expected, build};
}

HardExpectations alike(const HardExpectation& expected) { return {expected, expected, expected}; }

// A late or slow line reduces the force to what is stable (engine/live/force_guard.h), so that the hand goes deeper
// than it was recorded, and is not within the JND: steps and energy count.
void add_lines(std::vector<HardCase>& cases, const TrainingsPointer& trainings) {
  struct Line {
    const char* name;
    double delay_s, sample_s;
    // Of the light and the heavy hand, on springs and dashpots and on the stiff block.
    HardExpectation maxwell[2], stiff[2];
  };
  const Line lines[] = {
      {"10 kHz, no delay",
       0.0,
       1e-4,
       {{0.9, 0.3, 0.4, kNone_J}, {0.9, 0.25, 0.2, kNone_J}},
       {{0.0, 3.0, 1.5, kNone_J}, {0.0, 1.5, 0.4, kNone_J}}},
      {"1 kHz, no delay",
       0.0,
       1e-3,
       {{0.9, 0.3, 0.4, kNone_J}, {0.9, 0.25, 0.2, kNone_J}},
       {{0.0, 3.0, 1.5, kNone_J}, {0.0, 1.5, 0.4, kNone_J}}},
      {"1 kHz, 3 ms late",
       3e-3,
       1e-3,
       {{0.0, 4.0, 0.5, kNone_J}, {0.0, 2.0, 0.15, kNone_J}},
       {{0.0, 50.0, 0.5, kNone_J}, {0.0, 8.0, 0.2, kNone_J}}},
      {"1 kHz, 10 ms late",
       10e-3,
       1e-3,
       {{0.0, 30.0, 0.15, kNone_J}, {0.0, 5.0, 0.05, kNone_J}},
       {{0.0, 100.0, 0.25, 1.5e-3}, {0.0, 10.0, 0.06, kNone_J}}},
      {"100 Hz, no delay",
       0.0,
       10e-3,
       {{0.0, 10.0, 2.5, kNone_J}, {0.0, 4.0, 0.25, kNone_J}},
       {{0.0, 80.0, 1.0, 2.5e-4}, {0.0, 8.0, 0.25, kNone_J}}},
      {"100 Hz, 10 ms late",
       10e-3,
       10e-3,
       {{0.0, 50.0, 0.25, kNone_J}, {0.0, 5.0, 0.08, kNone_J}},
       {{0.0, 150.0, 0.8, 2e-3}, {0.0, 10.0, 0.1, kNone_J}}},
  };
  for (const bool stiff : {false, true}) {
    for (const Line& line : lines) {
      for (const std::size_t hand : {0U, 1U}) {
        LoopSettings settings{hand == 0 ? kLight : heavy(), kEncoder_m, line.delay_s};
        settings.sample_s = line.sample_s;
        cases.push_back(hand_case(trainings, std::string(kHands[hand]) + line.name,
                                  stiff ? "3 kN/m, with little damping" : "springs and dashpots",
                                  alike(stiff ? line.stiff[hand] : line.maxwell[hand]), stiff ? "stiff" : "maxwell",
                                  {settings}));
      }
    }
  }
}

void add_memory(std::vector<HardCase>& cases, const TrainingsPointer& trainings) {
  struct Memory {
    const char* material;
    HardExpectations light, heavy;
  };
  const Memory memories[] = {
      {"friction",
       {{0.25, 2, 2, 0.00015}, {0.6, 1, 0.6, 0.0002}, {0.6, 1, 0.8, kNone_J}, {{"kdtree-100", {0, 1.5, 0.4, kNone_J}}}},
       {{0.35, 0.6, 0.2, kNone_J},
        {0.9, 0.25, 0.1, kNone_J},
        {0.8, 0.3, 0.1, kNone_J},
        {{"kdtree-100", {0.05, 1.5, 0.4, kNone_J}}}}},
      {"sponge",
       {{0, 8, 4, 0.002}, {0.6, 2.5, 1.5, kNone_J}, {0.8, 2.5, 1.5, kNone_J}, {{"kdtree-100", {0.05, 8, 8, 0.0015}}}},
       {{0, 6, 0.6, kNone_J},
        {0.75, 1, 0.25, kNone_J},
        {0.4, 1.5, 0.25, kNone_J},
        {{"kdtree-100", {0.05, 2.5, 2.5, kNone_J}}}}},
      {"layered",
       {{0.7, 2.5, 1.5, 0.00015}, {0.9, 4, 1.5, kNone_J}, {0.7, 4, 1.5, kNone_J}},
       {{0, 0.4, 0.15, kNone_J},
        {0.98, 0.06, 0.04, kNone_J},
        {0.98, 0.25, 0.1, kNone_J},
        {{"kdtree-100", {0, 0.8, 0.4, kNone_J}}}}},
  };
  for (const Memory& one : memories) {
    for (const std::size_t hand : {0U, 1U}) {
      const LoopSettings settings{hand == 0 ? kLight : heavy(), kEncoder_m, 1e-3};
      cases.push_back(hand_case(trainings, std::string(kHands[hand]) + "1 kHz, 1 ms late", "a material with memory",
                                hand == 0 ? one.light : one.heavy, one.material, {settings}));
    }
  }
}

void add_events(std::vector<HardCase>& cases, const TrainingsPointer& trainings) {
  struct Event {
    const char* material;
    HardExpectations released, swapped;
  };
  const Event events[] = {
      {"maxwell",
       {{0.9, 0.25, 0.25, 0.0004}, {0.98, 0.1, 0.2, kNone_J}, {0.98, 0.1, 0.2, kNone_J}},
       {{0.2, 0.8, 0.2, kNone_J},
        {0.98, 0.1, 0.15, kNone_J},
        {0.98, 0.15, 0.15, kNone_J},
        {{"kdtree-100", {0.2, 0.8, 0.2, 0.00025}}}}},
      {"stiff",
       {{0, 4, 1.5, kNone_J}, {0, 4, 1.5, kNone_J}, {0, 4, 1.5, kNone_J}},
       {{0, 2, 0.4, kNone_J}, {0, 1.5, 0.4, kNone_J}, {0, 1.5, 0.4, kNone_J}}},
  };
  for (const Event& one : events) {
    cases.push_back(hand_case(trainings, "a pressed mass is released", "nothing damps its motion", one.released,
                              one.material, {{mass_alone(), kEncoder_m, 1e-3}}));
    HandTrial swap{{grips()[1], kEncoder_m, 1e-3}};
    swap.exchange_s = 0.1;
    cases.push_back(hand_case(trainings, "swap while pressing", "for the trend and back, every 100 ms", one.swapped,
                              one.material, swap));
  }
}

}  // namespace

std::vector<HardCase> material_cases() {
  const auto trainings = std::make_shared<Trainings>();
  std::vector<HardCase> cases;
  add_motions(cases, trainings);
  add_lines(cases, trainings);
  add_memory(cases, trainings);
  add_events(cases, trainings);
  return cases;
}

}  // namespace palpate
