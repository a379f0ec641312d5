// What sensors and hands do wrong, on a soft block that the features describe: the true force of another press decides.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/random_stream.h"
#include "engine/tick/replay.h"
#include "scenes/hard/hard_trials.h"
#include "scenes/material/maxwell_block.h"

namespace palpate {
namespace {

constexpr double kRecordedSeconds = 6.0;
constexpr double kRecordedRate_Hz = 125.0;

// Up to about 2.5 N at 6 mm.
constexpr MaxwellParameters kSoft = {.elastic_linear_N_per_m = 300.0,
                                     .elastic_quadratic_N_per_m2 = 2e4,
                                     .viscosity_Ns_per_m2 = 500.0,
                                     .branches = {{{0.17, 100.0, 0.0}}}};
constexpr double kLargest_N = 2.5;

// The recording of a case and the press that it is tested on.
struct FaultyPress {
  Path training = training_path(0);
  Path tested = training_path(1);
  std::vector<double> times_s = even_times(kRecordedSeconds, kRecordedRate_Hz);
  PressSensors sensors{};
  std::function<void(std::vector<RecordingRow>&)> fault{};

  void move(double factor, double offset_m) {
    training = scaled(training, factor, offset_m);
    tested = scaled(tested, factor, offset_m);
  }
  // Changes each force.
  template <typename Change>
  void change(Change to) {
    fault = [to](std::vector<RecordingRow>& rows) {
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].force_N = to(i, rows[i].force_N);
    };
  }
};

HardTrial build(const FaultyPress& presses) {
  MaxwellBlock block(kSoft);
  Recording recording = press_into(block, presses.training, presses.times_s, presses.sensors).recording;
  if (presses.fault) presses.fault(recording.rows);
  const TrainingScene scene{
      "hard case",
      {{FeatureKind::depth, 0.0, {}}, {FeatureKind::velocity, 0.0, {}}, {FeatureKind::lowpass_velocity, 0.17, {}}},
      {}};
  const auto tested = std::make_shared<const Press>(press_into(block, presses.tested, even_times(4.0, 1000.0)));
  return {std::make_shared<HardTraining>(ModelFits({prepare_recording(std::move(recording))}, scene), ModelPlan{}),
          [tested](const auto& model) { return measure_press(*tested, model); }};
}

std::vector<double> jittered_times() {
  RandomStream random(7, 5);
  std::vector<double> times_s = even_times(kRecordedSeconds, kRecordedRate_Hz);
  for (double& time_s : times_s) time_s += random.uniform(-0.45, 0.45) / kRecordedRate_Hz;
  return times_s;
}

// The times outside of these intervals; one in `one_in` of the others is lost, too (0: none).
std::vector<double> times_without(std::initializer_list<std::pair<double, double>> gaps_s, std::size_t one_in) {
  RandomStream random(7, 6);
  std::vector<double> kept_s;
  for (const double time_s : even_times(kRecordedSeconds, kRecordedRate_Hz)) {
    const bool lost = one_in > 0 && random.index(one_in) == 0;
    const bool gap = std::ranges::any_of(gaps_s, [&](const auto& g) { return time_s > g.first && time_s < g.second; });
    if (!lost && !gap) kept_s.push_back(time_s);
  }
  return kept_s;
}

}  // namespace

std::vector<HardCase> recording_cases() {
  // The change of the true force from tick to tick is 17 mN. No energy beyond what the sensors hide.
  constexpr double kNoEnergy_J = 1e-4;
  const auto expect = [&](double within, double error_N, double step_N) {
    return HardExpectation{within, error_N, step_N, kNoEnergy_J};
  };
  const HardExpectation paper = expect(0.99, 0.15, 0.04), good = expect(0.99, 0.1, 0.05);
  const HardExpectations all{paper, good, good};
  const HardExpectation refused{.refusal = "no sample of the training recordings is in contact"};
  std::vector<HardCase> cases;
  const auto add = [&](const char* name, const char* why, const HardExpectations& expected,
                       const std::function<void(FaultyPress&)>& shape) {
    cases.push_back({name, HardKind::recording, why, expected, [shape] {
                       FaultyPress presses;
                       shape(presses);
                       return build(presses);
                     }});
  };
  add("recording, nothing wrong", "six seconds at 125 Hz", all, [](FaultyPress&) {});
  add("forces near zero", "a fiftieth of the depth, 1/f weighs every sample alike", all,
      [](FaultyPress& p) { p.move(0.02, 0.0); });
  add("all forces read zero", "the sensor is not connected: a model of no force",
      {expect(0.0, 2.6, 1e-9), expect(0.0, 2.6, 1e-9), expect(0.0, 2.6, 1e-9)},
      [](FaultyPress& p) { p.change([](std::size_t, double) { return 0.0; }); });
  add("one outlier of 100 N", "at the deepest sample", all, [](FaultyPress& p) {
    p.fault = [](std::vector<RecordingRow>& rows) {
      std::ranges::max_element(rows, {}, &RecordingRow::position_m)->force_N = 100.0;
    };
  });
  add("noise of a fifth", "of the force", {expect(0.7, 0.6, 0.05), expect(0.99, 0.3, 0.05), expect(0.99, 0.3, 0.05)},
      [](FaultyPress& p) {
        p.change([random = std::make_shared<RandomStream>(7, 4)](std::size_t, double f) {
          return f * (1.0 + 0.2 * random->normal());
        });
      });
  add("noise 10 times the signal",
      "25 N of noise on at most 2.5 N; known limitation: cross-validation takes a correction of the noise",
      {{0.0, 60.0, 8.0, 0.1}, expect(0.0, 5.0, 1.0), {0.0, 90.0, 10.0, 0.1}},
      [](FaultyPress& p) { p.sensors.force_noise_N = 10.0 * kLargest_N; });
  add("a force sensor that drifts", "by 0.2 N in the recording",
      {expect(0.75, 0.4, 0.04), expect(0.65, 0.3, 0.05), expect(0.65, 0.3, 0.12)}, [](FaultyPress& p) {
        p.change([](std::size_t i, double f) {
          return f + 0.2 * static_cast<double>(i) / (kRecordedSeconds * kRecordedRate_Hz);
        });
      });
  add("a saturated sensor", "at 1 N, two fifths of the largest force: forces above are not known",
      {expect(0.2, 2.0, 0.06), expect(0.2, 2.0, 0.04), expect(0.2, 2.0, 0.04)},
      [](FaultyPress& p) { p.change([](std::size_t, double f) { return std::min(f, 1.0); }); });
  add("drop-outs of the force", "reads 0 for 40 ms, ten times; the weights 1/f follow them",
      {expect(0.4, 3.2, 0.15), good, good},
      [](FaultyPress& p) { p.change([](std::size_t i, double f) { return i % 75 < 5 ? 0.0 : f; }); });
  add("quantised positions", "an encoder step of 0.25 mm", {expect(0.97, 0.15, 0.15), good, expect(0.99, 0.15, 0.1)},
      [](FaultyPress& p) { p.sensors.encoder_step_m = 0.25e-3; });
  add("strokes that contradict", "the second half is 1.3 times as stiff; the first is tested",
      {expect(0.3, 1.2, 0.04), expect(0.5, 0.9, 0.08), expect(0.25, 0.9, 0.08)}, [](FaultyPress& p) {
        p.change([](std::size_t i, double f) {
          return 2 * static_cast<double>(i) < kRecordedSeconds * kRecordedRate_Hz ? f : 1.3 * f;
        });
      });
  add("a shorter range than the test", "recorded to 3 mm, tested to 6 mm: greater depths are not known",
      {expect(0.2, 1.8, 0.04), expect(0.35, 1.5, 0.04), expect(0.35, 1.5, 0.04)},
      [](FaultyPress& p) { p.training = scaled(p.training, 0.5, 0.0); });
  add("lost samples", "one in ten", all, [](FaultyPress& p) { p.times_s = times_without({}, 10); });
  add("gaps in time", "a quarter of a second twice, half a second once", {expect(0.9, 0.2, 0.04), good, good},
      [](FaultyPress& p) {
        p.times_s = times_without({{1.2, 1.45}, {2.6, 2.85}, {3.9, 4.4}}, 0);
      });
  add("10 Hz", "the slowest rate", {expect(0.95, 0.3, 0.15), good, good},
      [](FaultyPress& p) { p.times_s = even_times(30.0, 10.0); });
  add("20 kHz", "the fastest rate, for 0.6 s: less than one stroke",
      {expect(0.4, 0.8, 0.3), expect(0.8, 0.3, 0.04), expect(0.8, 0.3, 0.04)},
      [](FaultyPress& p) { p.times_s = even_times(0.6, 20000.0); });
  add("jittered time stamps", "by up to 45 % of the period", {expect(0.9, 0.3, 0.04), good, good},
      [](FaultyPress& p) { p.times_s = jittered_times(); });
  add("never leaves the surface", "the recording begins under load", all, [](FaultyPress& p) { p.move(0.4, 0.004); });
  add("never touches", "20 mm above the surface", {refused, refused, refused},
      [](FaultyPress& p) { p.move(1.0, -0.02); });
  add("the tool stands still", "at 3 mm: only the force there is known",
      {expect(0.0, 2.0, 2.0), expect(0.2, 1.6, 0.04), expect(0.2, 1.6, 0.04)},
      [](FaultyPress& p) { p.training = [](double) { return 0.003; }; });
  return cases;
}

}  // namespace palpate
