// The display of palpate-bench: one line per median, and at the end the rows
// that the paper of 2009 has figures for, each also at the pace of a reference
// machine. (JSON and CSV are Google Benchmark's own, with all statistics.)
#pragma once

#include <benchmark/benchmark.h>

#include <map>
#include <string>
#include <vector>

namespace palpate::bench {

class MedianReporter final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

 private:
  std::map<std::string, double> seconds_;  // median by name
};

}  // namespace palpate::bench
