// The time of a whole `palpate fit`, from the command line to the model file, and of a
// whole replayed tick.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/haptics_tick.h"
#include "engine/tick/sensor_identification.h"
#include "tests/bench/bench_data.h"
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

void replayed_motion(benchmark::State& state) {
  const auto recording = test::test_recording("silicone");
  const SensorSpec sensor = identify_sensor(recording->rows.data(), recording->rows.size(), recording->columns);
  MotionEstimator motion(sensor);
  std::size_t at = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(motion.update(tool_sample(recording->rows[at])));
    if (++at < recording->rows.size()) continue;
    at = 0;
    motion.reset();
  }
}

void replayed_tick(benchmark::State& state, const Method* method) {
  const auto recording = test::test_recording("silicone");
  const SensorSpec sensor = identify_sensor(recording->rows.data(), recording->rows.size(), recording->columns);
  HapticsTick tick(sensor, {test::fit(recorded(), method)});
  std::size_t at = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(tick.step(tool_sample(recording->rows[at])).force_N[0]);
    if (++at < recording->rows.size()) continue;
    at = 0;
    tick.reset();
  }
}

const int registered = [] {
  const auto in_ticks = [](benchmark::internal::Benchmark* one) {
    one->Repetitions(kRepetitions)->MinTime(0.05)->ReportAggregatesOnly();
  };
  in_ticks(benchmark::RegisterBenchmark("tick/motion", replayed_motion));
  in_ticks(benchmark::RegisterBenchmark("tick/whole_greedy", replayed_tick, &kGreedyMethod));
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
