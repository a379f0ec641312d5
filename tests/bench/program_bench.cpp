// The time of a whole `palpate fit`, from the command line to the model file, and of a
// whole replayed tick.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/haptics_tick.h"
#include "engine/tick/motion_estimator.h"
#include "models/model/file/model_io.h"
#include "tests/support/fitting.h"
#include "tests/support/temporary_folder.h"

namespace palpate::bench {
namespace {

constexpr int kRepetitions = 7;

// Runs `palpate` from the folder of this program.
bool run(const std::string& arguments) {
  const auto program = std::filesystem::canonical("/proc/self/exe").parent_path() / "palpate";
  return std::system((program.string() + " " + arguments + " >/dev/null 2>&1").c_str()) == 0;
}

void fit_program(benchmark::State& state, const std::string& options) {
  const test::TemporaryFolder folder;
  const std::string recording = folder.file("silicone.csv");
  if (!run("synth --material silicone --seed 1 --seconds 41.499 --out " + recording)) {
    return state.SkipWithError("palpate synth does not run: build it beside palpate-bench");
  }
  for (auto _ : state) {
    if (!run("fit --recording " + recording + " " + options + " --force --out " + folder.file("model.json"))) {
      return state.SkipWithError("palpate fit does not run");
    }
  }
}

// A model and the recording that its ticks replay: a virtual material, or a recorded set beside the sources.
struct TickSubject {
  std::shared_ptr<const ForceModel> model;
  std::vector<ToolSample> samples;
  SensorSpec sensor;
};

std::optional<TickSubject> tick_subject(const std::string& set, const std::string& method) {
  static const test::TemporaryFolder folder;
  const std::filesystem::path shared = test::real_data().parent_path();
  std::string train = folder.file(set + "-train.csv"), test = folder.file(set + "-test.csv");
  if (set == "ur3e") {
    train = shared / "data/ur3e_press_mit/train_cycle1.csv", test = shared / "data/ur3e_press_mit/test_cycle2.csv";
  } else if (set == "foam_slab") {
    train = shared / "labs/foam_slab/train_3.csv", test = shared / "labs/foam_slab/test_2.csv";
  } else if (!std::filesystem::exists(test)) {
    const std::string synth = "synth --material " + set + " --seconds 41.499 --seed ";
    if (!run(synth + "1 --out " + train) || !run(synth + "2 --out " + test)) return std::nullopt;
  }
  const std::string file = folder.file("model.json");
  if (!run("fit --recording " + train + " --method " + method + " --force --out " + file)) return std::nullopt;
  const auto model = load_model(file);
  const auto recording = read_recording(test);
  if (!model || !recording) return std::nullopt;
  TickSubject subject{*model, {}, identify_sensor(recording->rows.data(), recording->rows.size(), recording->columns)};
  for (const RecordingRow& row : recording->rows) subject.samples.push_back(tool_sample(row));
  return subject;
}

// The least ns per sample of seven rounds of `round`, which processes all samples.
double least_ns(const TickSubject& subject, const std::function<void()>& round) {
  double least_s = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kRepetitions; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    round();
    least_s = std::min(least_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return 1e9 * least_s / static_cast<double>(subject.samples.size());
}

// A whole replayed tick, and the shares of its stages.
void replayed_tick(benchmark::State& state, const std::string& set, const std::string& method) {
  const auto subject = tick_subject(set, method);
  if (!subject) return state.SkipWithError("no recordings, or palpate is not built beside palpate-bench");
  HapticsTick tick(subject->sensor, {subject->model});
  std::size_t at = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(tick.step(subject->samples[at]).force_N[0]);
    if (++at < subject->samples.size()) continue;
    at = 0;
    tick.reset();
  }
  const std::size_t count = subject->samples.size();
  std::vector<MotionEstimate> motion(count);
  std::vector<FeatureVector> features(count);
  state.counters["motion_ns"] = least_ns(*subject, [&] {
    MotionEstimator estimator(subject->sensor);
    for (std::size_t i = 0; i < count; ++i) motion[i] = estimator.update(subject->samples[i]);
  });
  state.counters["features_ns"] = least_ns(*subject, [&] {
    FeatureFilter filter(subject->model->features(), subject->model->deepest_m());
    for (std::size_t i = 0; i < count; ++i) features[i] = filter.update(subject->samples[i], motion[i]);
  });
  state.counters["force_ns"] = least_ns(*subject, [&] {
    for (const FeatureVector& one : features)
      if (one.in_contact) benchmark::DoNotOptimize(subject->model->force(one.values.data()));
  });
}

const int registered = [] {
  for (const std::string set : {"silicone", "button", "layered", "ur3e", "foam_slab"}) {
    for (const std::string method : {"voxel", "greedy", "trend", "trend+greedy"}) {
      benchmark::RegisterBenchmark(("tick/" + set + "/" + method).c_str(), replayed_tick, set, method)
          ->Repetitions(kRepetitions)
          ->Iterations(200000)
          ->ReportAggregatesOnly();
    }
  }
  for (const auto& [name, options] : {std::pair{"program/fit_random", "--method random --features scene"},
                                      std::pair{"program/fit_greedy", "--method greedy --features scene"},
                                      std::pair{"program/fit_greedy_auto", "--method greedy"}}) {
    benchmark::RegisterBenchmark(name, fit_program, options)
        ->Repetitions(kRepetitions)
        ->Iterations(1)
        ->UseRealTime()
        ->ReportAggregatesOnly()
        ->Unit(benchmark::kMillisecond);
  }
  return 0;
}();

}  // namespace
}  // namespace palpate::bench
