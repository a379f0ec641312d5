#include "tests/bench/bench_report.h"

#include <cstdio>
#include <iostream>
#include <string>

namespace palpate::bench {
namespace {

// "fit/random-100" of "fit/random-100/iterations:1/repeats:7/real_time".
std::string plain_name(const benchmark::BenchmarkReporter::Run& run) {
  std::string name = run.run_name.function_name;
  if (!run.run_name.args.empty()) name += "/" + run.run_name.args;
  return name;
}

}  // namespace

bool MedianReporter::ReportContext(const Context& context) {
  PrintBasicContext(&std::cout, context);
  std::cout << "\n" << std::flush;
  return true;
}

void MedianReporter::ReportRuns(const std::vector<Run>& runs) {
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
    row.seconds =
        (wall ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime()) / benchmark::GetTimeUnitMultiplier(run.time_unit);
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

void MedianReporter::Finalize() { print_tables(rows_); }

}  // namespace palpate::bench
