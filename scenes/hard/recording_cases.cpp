// What sensors and hands do wrong, on a soft block that the features describe: the true force of another press decides.
#include <algorithm>
#include <cmath>

#include "engine/base/random_stream.h"
#include "scenes/hard/hard.h"
#include "scenes/material/material_laws.h"

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
  const auto tested = std::make_shared<const Press>(press_into(block, presses.tested, even_times(4.0, 1000.0)));
  return {train_on(std::move(recording)), [tested](const auto& model) { return measure_press(*tested, model); }};
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

// In and out between the air and the full depth, at one speed.
Path at_one_speed(double speed_m_per_s) {
  return [=](double time_s) {
    constexpr double kWay_m = kTrainingDepth_m - kInAir_m;
    const double phase = std::fmod(speed_m_per_s * time_s / kWay_m, 2.0);
    return kInAir_m + kWay_m * (phase < 1.0 ? phase : 2.0 - phase);
  };
}

struct RecordingCase {
  const char* name;
  void (*shape)(FaultyPress& press);
};
const RecordingCase kRecordingCases[] = {
    {"recording, nothing wrong", [](FaultyPress&) {}},
    {"forces near zero", [](FaultyPress& p) { p.move(0.02, 0.0); }},
    {"all forces read zero", [](FaultyPress& p) { p.change([](std::size_t, double) { return 0.0; }); }},
    {"one outlier of 100 N",
     [](FaultyPress& p) {
       p.fault = [](std::vector<RecordingRow>& rows) {
         std::ranges::max_element(rows, {}, &RecordingRow::position_m)->force_N = 100.0;
       };
     }},
    {"noise of a fifth",
     [](FaultyPress& p) {
       p.change([random = std::make_shared<RandomStream>(7, 4)](std::size_t, double f) {
         return f * (1.0 + 0.2 * random->normal());
       });
     }},
    {"noise 10 times the signal", [](FaultyPress& p) { p.sensors.force_noise_N = 10.0 * kLargest_N; }},
    {"a force sensor that drifts",
     [](FaultyPress& p) {
       p.change([](std::size_t i, double f) {
         return f + 0.2 * static_cast<double>(i) / (kRecordedSeconds * kRecordedRate_Hz);
       });
     }},
    {"a saturated sensor", [](FaultyPress& p) { p.change([](std::size_t, double f) { return std::min(f, 1.0); }); }},
    {"drop-outs of the force",
     [](FaultyPress& p) { p.change([](std::size_t i, double f) { return i % 75 < 5 ? 0.0 : f; }); }},
    {"quantised positions", [](FaultyPress& p) { p.sensors.encoder_step_m = 0.25e-3; }},
    {"strokes that contradict",
     [](FaultyPress& p) {
       p.change([](std::size_t i, double f) {
         return 2 * static_cast<double>(i) < kRecordedSeconds * kRecordedRate_Hz ? f : 1.3 * f;
       });
     }},
    {"the force is late",
     [](FaultyPress& p) {
       p.fault = [](std::vector<RecordingRow>& rows) {
         for (std::size_t i = rows.size(); i-- > 3;) rows[i].force_N = rows[i - 3].force_N;
       };
     }},
    {"one constant speed", [](FaultyPress& p) { p.training = at_one_speed(0.02); }},
    {"slow training, fast test",
     [](FaultyPress& p) {
       p.training = at_one_speed(0.001);
       p.times_s = even_times(3.0 * kRecordedSeconds, kRecordedRate_Hz);
       p.tested = [path = p.tested](double t) { return path(3.0 * t); };
     }},
    {"a shorter range than the test", [](FaultyPress& p) { p.training = scaled(p.training, 0.5, 0.0); }},
    {"lost samples", [](FaultyPress& p) { p.times_s = times_without({}, 10); }},
    {"gaps in time",
     [](FaultyPress& p) {
       p.times_s = times_without({{1.2, 1.45}, {2.6, 2.85}, {3.9, 4.4}}, 0);
     }},
    {"10 Hz", [](FaultyPress& p) { p.times_s = even_times(30.0, 10.0); }},
    {"20 kHz", [](FaultyPress& p) { p.times_s = even_times(0.6, 20000.0); }},
    {"jittered time stamps", [](FaultyPress& p) { p.times_s = jittered_times(); }},
    {"never leaves the surface", [](FaultyPress& p) { p.move(0.4, 0.004); }},
    {"never touches", [](FaultyPress& p) { p.move(1.0, -0.02); }},
    {"the tool stands still", [](FaultyPress& p) { p.training = [](double) { return 0.003; }; }},
};

}  // namespace

std::vector<HardCase> recording_cases() {
  std::vector<HardCase> cases;
  for (const RecordingCase& one : kRecordingCases) {
    cases.push_back({one.name, HardKind::recording, [shape = one.shape] {
                       FaultyPress presses;
                       shape(presses);
                       return build(presses);
                     }});
  }
  return cases;
}

}  // namespace palpate
