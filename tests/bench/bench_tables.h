// The tables of tests/bench/README.md in Markdown, from the rows that were run.
#pragma once

#include <map>
#include <string>

namespace palpate::bench {

struct BenchRow {
  double seconds = 0.0;  // median
  std::map<std::string, double> counters;
  std::string label;
};

using BenchRows = std::map<std::string, BenchRow>;  // by name, e.g. "fit/random-100"

// Three digits and a unit: "78.1 ns".
std::string duration(double seconds);

// Prints a table to stdout for each group with at least one row.
void print_tables(const BenchRows& rows);

}  // namespace palpate::bench
