// The output of palpate-bench: one line per median, and at the end the tables of
// tests/bench/README.md. (Google Benchmark writes JSON and CSV with all statistics.)
#pragma once

#include <benchmark/benchmark.h>

#include <vector>

#include "tests/bench/bench_tables.h"

namespace palpate::bench {

class MedianReporter final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  BenchRows rows_;
};

}  // namespace palpate::bench
