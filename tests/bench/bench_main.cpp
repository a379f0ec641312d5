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
// slider/     a change of the number of centres of an existing fit
// tick/       one sample of a replay, whole and its motion alone
// program/    `palpate fit` from the command line to the model file
// size/       fits against the number of sites, 1,000 to 1,000,000
// feature/    a tick of the feature filter, one kind of feature at a time
// dimension/  fits and evaluation against the number of features, 1 to 8
// peer/       Palpate's methods beside ALGLIB, dlib and scipy where these are
//             installed: fit, query and error on the same recordings
//
// Prints the tables of tests/bench/README.md at the end. Figures are medians over
// repetitions: processor time of queries, and wall time of fits (which use all
// cores). Only ratios within one run are comparable.
#include <benchmark/benchmark.h>

#include <fstream>
#include <string>

#include "engine/base/parallel.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/rbf_simd.h"
#include "tests/bench/bench_report.h"

namespace {

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0 || line.rfind("CPU part", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

void add_peer_context() {
#ifndef PALPATE_WITH_ALGLIB
  benchmark::AddCustomContext("peer ALGLIB", "not installed, apt install libalglib-dev, then configure again");
#endif
#ifndef PALPATE_WITH_DLIB
  benchmark::AddCustomContext("peer dlib", "not installed, apt install libdlib-dev, then configure again");
#endif
#ifndef PALPATE_PYTHON
  benchmark::AddCustomContext("peer scipy", "not installed, apt install python3-scipy, then configure again");
#endif
}

}  // namespace

int main(int argc, char** argv) {
  palpate::prepare_blas();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::AddCustomContext("cpu", cpu_name());
  benchmark::AddCustomContext("threads of a fit", std::to_string(palpate::thread_count()));
#ifdef __clang__
  benchmark::AddCustomContext("compiler", "clang " __clang_version__);
#else
  benchmark::AddCustomContext("compiler", "g++ " __VERSION__);
#endif
  benchmark::AddCustomContext("build type", PALPATE_BUILD_TYPE);
  benchmark::AddCustomContext("instructions", palpate::simd::target_name());
  benchmark::AddCustomContext("commit", *PALPATE_COMMIT != '\0' ? PALPATE_COMMIT : "unknown");
  add_peer_context();
  palpate::bench::MedianReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  benchmark::Shutdown();
  return 0;
}
