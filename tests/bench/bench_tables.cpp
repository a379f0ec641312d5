#include "tests/bench/bench.h"

#include <cstdio>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/text.h"

namespace palpate::bench {
namespace {

struct Goal {
  const char* work;
  const char* benchmark;
  const char* paper;
  const char* goal;
};

constexpr Goal kGoals[] = {
    {"evaluation, 100 centres", "evaluate/rbf/100", "60 us", "80 ns"},
    {"evaluation, 6,850 centres", "evaluate/rbf/6850", "-", "3.8 us"},
    {"voxel look-up, 4-D", "evaluate/voxel_25x11x11x11", "-", "30 ns"},
    {"random-100", "fit/random-100", "4 s", "15 ms"},
    {"kD-tree-100", "fit/kdtree-100", "5 min", "40 ms"},
    {"greedy-100, 20 candidates", "fit/greedy-100_of_20", "9 min", "0.1 s"},
    {"greedy-100, 100 candidates", "fit/greedy-100_of_100", "41 min", "0.15 s"},
    {"greedy-100, all sites", "fit/greedy-100_of_all", "-", "1.4 s"},
    {"direct + 25x11x11x11 grid", "fit/direct+grid", "50 min", "1.3 s"},
    {"whole tick in replay, greedy-100", "tick/silicone/greedy", "-", "0.5 us"},
    {"`fit` random, the program", "program/fit_random", "-", "90 ms"},
    {"`fit` greedy, the program", "program/fit_greedy", "-", "0.25 s"},
};

// The ratio of two times. It depends less than the times on other load of the machine.
struct Ratio {
  const char* work;
  const char* above;
  const char* below;
  const char* goal;
};

constexpr Ratio kScalarRatios[] = {
    {"100", "evaluate/scalar/100", "evaluate/rbf/100", "-"},
    {"500", "evaluate/scalar/500", "evaluate/rbf/500", "-"},
    {"1,000", "evaluate/scalar/1000", "evaluate/rbf/1000", "-"},
    {"6,850", "evaluate/scalar/6850", "evaluate/rbf/6850", "-"},
};

constexpr Ratio kWholeRatios[] = {
    {"greedy-100: model / its RBF alone", "evaluate/model/greedy", "evaluate/rbf/100", "1.35"},
    {"voxel: model / its look-up alone", "evaluate/model/voxel", "evaluate/voxel_25x11x11x11", "2"},
    {"every count to 200 / the fit of 200", "fit/greedy-1_to_200_of_100", "fit/greedy-200_of_100", "1.3"},
};

struct Column {
  const char* title;
  const char* benchmark;  // its rows: "<benchmark>/<number>"
  bool with_memory;
};

constexpr Column kSizeColumns[] = {
    {"random-100", "size/random-100", true},
    {"kD-tree-100", "size/kdtree-100", true},
    {"greedy-100, 100 candidates", "size/greedy-100_of_100", true},
};

std::string thousands(long value) { return with_thousands(std::to_string(value)); }

const BenchRow* find(const BenchRows& rows, const std::string& name) {
  const auto found = rows.find(name);
  return found != rows.end() ? &found->second : nullptr;
}

// A Markdown table. Title and header are printed before the first row, so that a table without rows is left out.
class Table {
 public:
  Table(std::string title, std::vector<std::string> header) : title_(std::move(title)), header_(std::move(header)) {}

  void add(const std::vector<std::string>& cells) {
    if (!title_.empty()) {
      std::printf("\n**%s**\n\n", title_.c_str());
      print(header_);
      std::printf("|---");
      for (std::size_t i = 1; i < header_.size(); ++i) std::printf("|---:");
      std::printf("|\n");
      title_.clear();
    }
    print(cells);
  }

 private:
  static void print(const std::vector<std::string>& cells) {
    for (const std::string& cell : cells) std::printf("| %s ", cell.c_str());
    std::printf("|\n");
  }

  std::string title_;  // empty once printed
  std::vector<std::string> header_;
};

void print_goals(const BenchRows& rows) {
  Table table("Speed", {"work (median)", "paper 2009", "here", "goal"});
  for (const Goal& goal : kGoals) {
    if (const BenchRow* row = find(rows, goal.benchmark))
      table.add({goal.work, goal.paper, duration(row->seconds), goal.goal});
  }
}

void print_ratios(const BenchRows& rows, Table table, std::span<const Ratio> ratios) {
  for (const Ratio& ratio : ratios) {
    const BenchRow* above = find(rows, ratio.above);
    const BenchRow* below = find(rows, ratio.below);
    if (above == nullptr || below == nullptr) continue;
    table.add({ratio.work, duration(above->seconds), duration(below->seconds),
               fixed(above->seconds / below->seconds, 2), ratio.goal});
  }
}

// One line for each number with a row in any of the columns.
void print_against(const BenchRows& rows, const std::string& title, const char* first,
                   std::span<const Column> columns) {
  std::set<long> numbers;
  std::vector<std::string> header{first};
  for (const Column& column : columns) {
    const std::string start = std::string(column.benchmark) + "/";
    for (const auto& [name, row] : rows)
      if (name.starts_with(start)) numbers.insert(std::stol(name.substr(start.size())));
    header.emplace_back(column.title);
    if (column.with_memory) header.emplace_back("peak memory");
  }
  Table table(title, header);
  for (const long number : numbers) {
    std::vector<std::string> cells{thousands(number)};
    for (const Column& column : columns) {
      const BenchRow* row = find(rows, std::string(column.benchmark) + "/" + std::to_string(number));
      cells.push_back(row != nullptr ? duration(row->seconds) : "-");
      if (column.with_memory) cells.push_back(row != nullptr ? general(row->counters.at("peak_MB"), 3) + " MB" : "-");
    }
    table.add(cells);
  }
}

}  // namespace

std::string duration(double seconds) {
  constexpr struct {
    double unit_s;
    const char* name;
  } kUnits[] = {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "us"}};
  for (const auto& [unit_s, name] : kUnits)
    if (seconds >= unit_s) return general(seconds / unit_s, 3) + " " + name;
  return general(1e9 * seconds, 3) + " ns";
}

void print_tables(const BenchRows& rows) {
  print_goals(rows);
  print_ratios(rows, Table("One evaluation", {"centres", "plain scalar loop, -O2", "here", "ratio", "goal"}),
               kScalarRatios);
  print_ratios(rows, Table("Whole beside bare", {"work", "whole", "bare", "ratio", "goal"}), kWholeRatios);
  print_against(rows, "Cost over N", "sites, 4-D", kSizeColumns);
  std::fflush(stdout);
}

}  // namespace palpate::bench
