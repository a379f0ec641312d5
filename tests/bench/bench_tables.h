// The tables of the README, in Markdown, from whatever rows were run.
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

// Prints a table for each group of rows that is there, to stdout.
void print_tables(const BenchRows& rows);

}  // namespace palpate::bench
