// Motions unlike the training, and a hand in closed loop, on virtual materials with automatically selected features.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "scenes/hard/hard.h"
#include "scenes/material/material.h"
#include "scenes/material/rig.h"

namespace palpate {
namespace {

// Long enough to identify every feature.
constexpr double kMaterialSeconds = 12.0;
constexpr double kMaterialRate_Hz = 250.0;

// The training on a material, and its greatest depth and force.
struct Training {
  std::shared_ptr<HardTraining> fits;
  double depth_m = 0.0, force_N = 0.0;
};
using Trainings = std::map<std::string, Training>;

// Makes the training when it is first needed.
const Training& training_on(const std::string& material, Trainings& made) {
  Training& one = made[material];
  if (one.fits) return one;
  RigSettings settings;
  settings.material = material;
  settings.seconds = kMaterialSeconds;
  settings.rate_Hz = kMaterialRate_Hz;
  Recording recording = std::move(*record_sensors(settings));
  one.depth_m = std::ranges::max_element(recording.rows, {}, &RecordingRow::position_m)->position_m;
  one.force_N = std::ranges::max_element(recording.rows, {}, &RecordingRow::force_N)->force_N;
  one.fits = train_on(std::move(recording));
  return one;
}

constexpr double kSlow_m_per_s = 0.05;  // of the sudden stop and of the endless press, at the size of the training

Path sine(double amplitude_m, double rate_Hz) {
  return [=](double t) { return amplitude_m * std::sin(2.0 * std::numbers::pi * rate_Hz * t); };
}

struct Motion {
  const char* name;
  Path (*path)(double size);  // `size`: greatest depth of the training over kTrainingDepth_m
  double seconds = 4.0;
};
const Motion kMotions[] = {
    {"half as deep again", [](double size) { return scaled(scaled(training_path(1), size, 0.0), 1.5, 0.0); }},
    {"three times as fast",
     [](double size) -> Path {
       return [path = scaled(training_path(1), size, 0.0)](double t) { return path(3.0 * t); };
     }},
    {"a hold ten times as long",
     [](double size) -> Path { return [=](double t) { return size * 0.004 * std::tanh(5.0 * t); }; }, 20.0},
    {"contact made and broken at 20 Hz", [](double size) { return sine(size * 0.003, 20.0); }},
    {"a sudden stop",
     [](double size) -> Path { return [=](double t) { return size * kSlow_m_per_s * std::min(t, 0.1); }; }, 1.0},
    {"deeper without end", [](double size) -> Path { return [=](double t) { return size * kSlow_m_per_s * t; }; },
     0.36},
    {"small cycles at depth",
     [](double size) -> Path {
       return [=, cycles = sine(size * 0.0002, 7.0)](double t) {
         return minimum_jerk(kInAir_m, size * 0.004, 0.4, t).aim_m + cycles(t);
       };
     }},
};

// Springs and dashpots, dry friction, a fluid in pores, a stiff inclusion at 6 mm.
void add_motions(std::vector<HardCase>& cases, const std::shared_ptr<Trainings>& trainings) {
  for (const std::string material : {"maxwell", "friction", "sponge", "layered"}) {
    for (const Motion& motion : kMotions) {
      cases.push_back(
          {material + ": " + motion.name, HardKind::motion, [=] {
             const Training& one = training_on(material, *trainings);
             const auto block = find_material(material)->make_block();
             const auto press = std::make_shared<const Press>(
                 press_into(*block, motion.path(one.depth_m / kTrainingDepth_m), even_times(motion.seconds, 1000.0)));
             return HardTrial{one.fits, [press](const auto& model) { return measure_press(*press, model); }};
           }});
    }
  }
}

constexpr double kPress = 0.3;  // of the largest force of the training

HardCase hand_case(const std::shared_ptr<Trainings>& trainings, const std::string& material, const std::string& name,
                   const HandTrial& trial) {
  return {material + ": " + name, HardKind::loop, [=] {
            const Training& one = training_on(material, *trainings);
            HandTrial at = trial;
            at.depth_m = std::sqrt(kPress) * one.depth_m;
            at.force_N = kPress * one.force_N;
            if (at.exchange_s > 0.0) at.other = one.fits->fit({"trend", *parse_plan("trend")}, {})->model;
            return HardTrial{one.fits, [=](const auto& model) {
                               const auto block = find_material(material)->make_block();
                               return measure_hand(at, *block, model);
                             }};
          }};
}

// A late or slow line reduces the force to what is stable (engine/live/force_guard.h), so that the hand goes deeper
// than it was recorded, and is not within the JND: steps and energy count.
struct Line {
  const char* name;
  double delay_s = 1e-3;
  double sample_s = 0.0;
};
constexpr Line kLines[] = {{"10 kHz, no delay", 0.0, 1e-4},  {"1 kHz, no delay", 0.0, 1e-3},
                           {"1 kHz, 3 ms late", 3e-3, 1e-3}, {"1 kHz, 10 ms late", 10e-3, 1e-3},
                           {"100 Hz, no delay", 0.0, 10e-3}, {"100 Hz, 10 ms late", 10e-3, 10e-3}};

// A finger in light contact, and a clenched fist (hard.h).
void add_hands(std::vector<HardCase>& cases, const std::shared_ptr<Trainings>& trainings, const std::string& material,
               const Line& line) {
  for (const auto& [hand, grip] :
       {std::pair{"light hand, ", Grip{"a light hand", 0.05, 100.0, 2.2}}, {"heavy hand, ", kGrips[2]}}) {
    HandTrial trial{{grip, kHardEncoder_m, line.delay_s}};
    trial.settings.sample_s = line.sample_s;
    cases.push_back(hand_case(trainings, material, std::string(hand) + line.name, trial));
  }
}

}  // namespace

std::vector<HardCase> material_cases() {
  const auto trainings = std::make_shared<Trainings>();
  std::vector<HardCase> cases;
  add_motions(cases, trainings);
  for (const char* material : {"maxwell", "stiff"})
    for (const Line& line : kLines) add_hands(cases, trainings, material, line);
  for (const char* material : {"friction", "sponge", "layered"})  // with memory
    add_hands(cases, trainings, material, {"1 kHz, 1 ms late"});
  for (const char* material : {"maxwell", "stiff"}) {
    cases.push_back(
        hand_case(trainings, material, "a pressed mass is released", {{mass_alone(), kHardEncoder_m, 1e-3}}));
    cases.push_back(hand_case(trainings, material, "swap while pressing", {{kGrips[1], kHardEncoder_m, 1e-3}, 0.1}));
    // What lines and devices do beside a constant delay.
    ClosedLoopSettings line{kGrips[1], kHardEncoder_m, 1e-3};
    line.sample_s = 1e-3;
    const auto add = [&](const char* name, const auto& change) {
      HandTrial trial{line};
      change(trial.settings);
      cases.push_back(hand_case(trainings, material, name, trial));
    };
    add("a delay of 1 to 4 ms", [](ClosedLoopSettings& at) { at.jitter_s = 3e-3; });
    add("one packet in ten is lost", [](ClosedLoopSettings& at) { at.lost_in = 10; });
    add("samples in groups of four", [](ClosedLoopSettings& at) { at.grouped = 4; });
    add("a device of 1 N", [](ClosedLoopSettings& at) { at.limits.largest_N = 1.0; });
  }
  return cases;
}

}  // namespace palpate
