// feature/NAME: the time of one tick of the feature filter with depth alone, and with one
// additional feature of each kind, with several numbers of parts for spectra and stops.
// Each tick depends on the previous one. The table has the difference.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "engine/tick/features.h"
#include "tests/support/example_model.h"

namespace palpate::bench {
namespace {

constexpr int kRepetitions = 9;
constexpr double kSeconds = 0.05;

FeatureSpec with_parts(FeatureKind kind, std::size_t count) {
  FeatureSpec spec;
  spec.kind = kind;
  spec.part_count = count;
  for (std::size_t p = 0; p < count; ++p) {
    const double size = static_cast<double>(p + 1);
    spec.parts[p] = {0.0, 0.0, {6e-3, {0.3, 0.1, 0.0, 0.05}}};
    (kind == FeatureKind::stops ? spec.parts[p].threshold_m : spec.parts[p].relaxation_time_s) =
        kind == FeatureKind::stops ? 1e-4 * size : 0.01 * size * size * size;
  }
  return spec;
}

// In contact half of the time, with steps of exactly and of nearly a millisecond.
void run(benchmark::State& state, const std::vector<FeatureSpec>& specs) {
  const Recording recording = test::example_recording(4096, 1000.0, 30e-6);
  FeatureFilter filter(specs);
  double time_s = 0.0;
  double last = 0.0;
  std::size_t at = 0;
  for (auto _ : state) {
    const RecordingRow& row = recording.rows[at];
    time_s += (at & 1U) != 0 ? 1e-3 : 1.01e-3;
    const double position_m = row.position_m + 1e-200 * last;
    last = filter.update({time_s, position_m, 0.0, 0.0}, {position_m, 0.01}).values[specs.size() - 1];
    at = at + 1 < recording.rows.size() ? at + 1 : 0;
  }
  benchmark::DoNotOptimize(last);
}

const int registered = [] {
  const auto add = [](const std::string& name, std::vector<FeatureSpec> more) {
    more.insert(more.begin(), FeatureSpec{});
    benchmark::RegisterBenchmark(("feature/" + name).c_str(), run, more)
        ->Repetitions(kRepetitions)
        ->MinTime(kSeconds)
        ->ReportAggregatesOnly();
  };
  add("depth", {});
  add("velocity", {{FeatureKind::velocity}});
  add("lowpass_velocity", {{FeatureKind::lowpass_velocity, 0.17}});
  for (const std::size_t parts : {std::size_t{1}, std::size_t{3}, std::size_t{8}}) {
    add("maxwell_spectrum of " + std::to_string(parts), {with_parts(FeatureKind::maxwell_spectrum, parts)});
    add("stops of " + std::to_string(parts), {with_parts(FeatureKind::stops, parts)});
  }
  return 0;
}();

}  // namespace
}  // namespace palpate::bench
