// palpate-bench measures all speed figures in one run on one machine.
//
//   build/palpate-bench                                       everything
//   build/palpate-bench --benchmark_filter='^(evaluate|fit)/' the table of speed, 1 minute
//   build/palpate-bench --benchmark_filter='^evaluate/(scalar|rbf)/'   seconds
//   build/palpate-bench --benchmark_filter='^size/'           one group
//   build/palpate-bench --benchmark_out=bench.json --benchmark_out_format=json
//   build/palpate-bench --benchmark_list_tests
//
// evaluate/   one query at a time, each depending on the previous one
// fit/        fits at 6,850 sites of a recording; `peak_MB`: additional memory
// tick/       one sample of a replay, whole and its motion alone
// program/    `palpate fit` from the command line to the model file
// size/       fits against the number of sites, 1,000 to 1,000,000
//
// Prints the tables of tests/bench/README.md at the end. Figures are medians over
// repetitions: processor time of queries, and wall time of fits (which use all
// cores). Only ratios within one run are comparable.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"
#include "models/model/vector_loops.h"
#include "tests/bench/bench.h"

namespace palpate::bench {
namespace {

// "fit/random-100" of "fit/random-100/iterations:1/repeats:7/real_time".
std::string plain_name(const benchmark::BenchmarkReporter::Run& run) {
  std::string name = run.run_name.function_name;
  if (!run.run_name.args.empty()) name += "/" + run.run_name.args;
  return name;
}

// Prints one line for each median, and the tables at the end.
class MedianReporter final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override {
    PrintBasicContext(&std::cout, context);
    std::cout << "\n" << std::flush;
    return true;
  }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      const std::string name = plain_name(run);
      if (run.error_occurred) {
        std::printf("%-40s skipped: %s\n", name.c_str(), run.error_message.c_str());
        continue;
      }
      const bool alone = run.run_type == Run::RT_Iteration && run.repetitions <= 1;
      if (!alone && run.aggregate_name != "median") continue;
      // Processor time for work on one thread, because other programs disturb it less.
      const bool wall = !run.run_name.time_type.empty();
      BenchRow row;
      row.seconds = (wall ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime()) /
                    benchmark::GetTimeUnitMultiplier(run.time_unit);
      row.label = run.report_label;
      std::printf("%-40s %10s", name.c_str(), duration(row.seconds).c_str());
      for (const auto& [counter, value] : run.counters) {
        row.counters[counter] = value.value;
        std::printf("   %s %.4g", counter.c_str(), value.value);
      }
      std::printf("%s%s\n", row.label.empty() ? "" : "   ", row.label.c_str());
      rows_[name] = row;
    }
    std::fflush(stdout);
  }

  void Finalize() override { print_tables(rows_); }

 private:
  BenchRows rows_;
};

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0 || line.rfind("CPU part", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

void add_context() {
  benchmark::AddCustomContext("cpu", cpu_name());
  benchmark::AddCustomContext("threads of a fit", std::to_string(thread_count()));
#ifdef __clang__
  benchmark::AddCustomContext("compiler", "clang " __clang_version__);
#else
  benchmark::AddCustomContext("compiler", "g++ " __VERSION__);
#endif
  benchmark::AddCustomContext("build type", PALPATE_BUILD_TYPE);
  benchmark::AddCustomContext("instructions", simd::target_name());
  benchmark::AddCustomContext("commit", *PALPATE_COMMIT != '\0' ? PALPATE_COMMIT : "unknown");
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  palpate::prepare_blas();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  palpate::bench::add_context();
  palpate::bench::MedianReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
  return 0;
}
