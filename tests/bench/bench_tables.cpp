#include "tests/bench/bench_tables.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <vector>

#include "engine/base/text.h"

namespace palpate::bench {
namespace {

// The time of a scalar loop over 6,850 centres on the reference machine of the
// goals, a Zen 4 core at 3.6 GHz.
constexpr double kReferenceScalar_s = 17.43e-6;

struct Goal {
  const char* work;
  const char* benchmark;
  const char* paper;
  const char* goal;
  const char* stretch;
};

constexpr Goal kGoals[] = {
    {"evaluation, 100 centres", "evaluate/rbf/100", "60 us", "80 ns", "64 ns"},
    {"evaluation, 6,850 centres", "evaluate/rbf/6850", "-", "3.8 us", "2.8 us"},
    {"voxel look-up, 4-D", "evaluate/voxel_25x11x11x11", "-", "30 ns", "-"},
    {"random-100", "fit/random-100", "4 s", "15 ms", "-"},
    {"kD-tree-100", "fit/kdtree-100", "5 min", "40 ms", "25 ms"},
    {"greedy-100, 20 candidates", "fit/greedy-100_of_20", "9 min", "0.1 s", "-"},
    {"greedy-100, 100 candidates", "fit/greedy-100_of_100", "41 min", "0.15 s", "0.1 s"},
    {"greedy-100, all sites", "fit/greedy-100_of_all", "-", "1.4 s", "0.8 s"},
    {"direct + 25x11x11x11 grid", "fit/direct+grid", "50 min", "1.3 s", "0.9 s"},
    {"whole tick in replay, greedy-100", "tick/whole_greedy", "-", "0.5 us", "0.35 us"},
    {"`fit` random, the program", "program/fit_random", "-", "90 ms", "50 ms"},
    {"`fit` greedy, the program", "program/fit_greedy", "-", "0.25 s", "0.15 s"},
};

// The ratio of the time of some work to that of its essential part.
struct Share {
  const char* work;
  const char* whole;
  const char* part;
  const char* goal;
};

constexpr Share kShares[] = {
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

constexpr Column kDimensionColumns[] = {
    {"random-100 fit", "dimension/random-100", false},
    {"greedy-100 fit", "dimension/greedy-100_of_100", false},
    {"grid of 10 a side from all sites", "dimension/grid_10_a_side", true},
    {"one evaluation, 100 centres", "dimension/evaluate_rbf", false},
    {"one grid look-up", "dimension/evaluate_grid", false},
};

std::string thousands(long value) { return with_thousands(std::to_string(value)); }

const BenchRow* find(const BenchRows& rows, const std::string& name) {
  const auto found = rows.find(name);
  return found != rows.end() ? &found->second : nullptr;
}

bool starts_with(const std::string& name, const std::string& start) { return name.rfind(start, 0) == 0; }

void print_row(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) std::printf("| %s ", cell.c_str());
  std::printf("|\n");
}

void print_header(const std::string& title, const std::vector<std::string>& cells) {
  std::printf("\n**%s**\n\n", title.c_str());
  print_row(cells);
  std::printf("|---");
  for (std::size_t i = 1; i < cells.size(); ++i) std::printf("|---:");
  std::printf("|\n");
}

// Ratios, which depend less than times on other load of the machine.
void print_ratios(const BenchRows& rows) {
  bool first = true;
  for (const char* centres : {"100", "500", "1000", "6850"}) {
    const BenchRow* slow = find(rows, std::string("evaluate/scalar/") + centres);
    const BenchRow* fast = find(rows, std::string("evaluate/rbf/") + centres);
    if (slow == nullptr || fast == nullptr) continue;
    if (first) print_header("One evaluation", {"centres", "plain scalar loop, -O2", "here", "ratio"});
    first = false;
    print_row({thousands(std::stol(centres)), duration(slow->seconds), duration(fast->seconds),
               fixed(slow->seconds / fast->seconds, 2)});
  }
}

void print_shares(const BenchRows& rows) {
  bool first = true;
  for (const Share& share : kShares) {
    const BenchRow* whole = find(rows, share.whole);
    const BenchRow* part = find(rows, share.part);
    if (whole == nullptr || part == nullptr) continue;
    if (first) print_header("Whole beside bare", {"work", "whole", "bare", "ratio", "goal"});
    first = false;
    print_row({share.work, duration(whole->seconds), duration(part->seconds), fixed(whole->seconds / part->seconds, 2),
               share.goal});
  }
}

void print_goals(const BenchRows& rows) {
  const BenchRow* scalar = find(rows, "evaluate/scalar/6850");
  const auto wanted = [&](const Goal& goal) { return find(rows, goal.benchmark) != nullptr; };
  if (std::none_of(std::begin(kGoals), std::end(kGoals), wanted)) return;
  std::vector<std::string> titles{"work (median)", "paper 2009", "here"};
  if (scalar != nullptr) titles.emplace_back("at reference pace");
  titles.emplace_back("goal");
  titles.emplace_back("stretch");
  print_header("Speed", titles);
  const double pace = scalar != nullptr ? kReferenceScalar_s / scalar->seconds : 1.0;
  for (const Goal& goal : kGoals) {
    const BenchRow* row = find(rows, goal.benchmark);
    if (row == nullptr) continue;
    std::vector<std::string> cells{goal.work, goal.paper, duration(row->seconds)};
    if (scalar != nullptr) cells.push_back(duration(pace * row->seconds));
    cells.emplace_back(goal.goal);
    cells.emplace_back(goal.stretch);
    print_row(cells);
  }
  if (scalar == nullptr) return;
  std::printf("\nReference pace: times x %.3f, so that the scalar loop takes 17.43 us at 6,850 centres.\n", pace);
}

// One line for each number with a row in any of the columns.
template <std::size_t count>
void print_against(const BenchRows& rows, const std::string& title, const char* first, const Column (&columns)[count]) {
  std::set<long> numbers;
  for (const auto& [name, row] : rows)
    for (const Column& column : columns)
      if (const std::string start = std::string(column.benchmark) + "/"; starts_with(name, start))
        numbers.insert(std::stol(name.substr(start.size())));
  if (numbers.empty()) return;
  std::vector<std::string> titles{first};
  for (const Column& column : columns) {
    titles.emplace_back(column.title);
    if (column.with_memory) titles.emplace_back("peak memory");
  }
  print_header(title, titles);
  for (const long number : numbers) {
    std::vector<std::string> cells{thousands(number)};
    for (const Column& column : columns) {
      const BenchRow* row = find(rows, std::string(column.benchmark) + "/" + std::to_string(number));
      cells.push_back(row != nullptr ? duration(row->seconds) : "-");
      if (column.with_memory) cells.push_back(row != nullptr ? general(row->counters.at("peak_MB"), 3) + " MB" : "-");
    }
    print_row(cells);
  }
}

// "feature/NAME": the time of a tick with that feature, less that with depth alone.
void print_features(const BenchRows& rows) {
  const BenchRow* alone = find(rows, "feature/depth");
  if (alone == nullptr) return;
  print_header("Features", {"feature", "one tick of the filter", "of which the feature"});
  for (const auto& [name, row] : rows) {
    if (!starts_with(name, "feature/")) continue;
    print_row({name.substr(8), duration(row.seconds), fixed(1e9 * (row.seconds - alone->seconds), 1) + " ns"});
  }
}

// "peer/DATA/NAME/fit" and "/query", one line for each name.
void print_peers(const BenchRows& rows) {
  std::string last_data;
  std::vector<std::string> settings;
  const auto print_settings = [&] {
    if (!settings.empty()) std::printf("\n");
    for (const std::string& setting : settings) std::printf("- %s\n", setting.c_str());
    settings.clear();
  };
  for (const auto& [name, fit] : rows) {
    if (!starts_with(name, "peer/") || name.substr(name.rfind('/')) != "/fit") continue;
    const std::string data = name.substr(5, name.find('/', 5) - 5);
    const std::string peer = name.substr(6 + data.size(), name.rfind('/') - 6 - data.size());
    const auto counter = [&counters = fit.counters](const char* key) { return counters.at(key); };
    if (data != last_data) {
      print_settings();
      print_header(
          "Beside peers: " + data + ", " + thousands(static_cast<long>(counter("test_samples"))) + " test samples",
          {"fitted by", "sites", "fit", "one query", "RMS [mN]", "within the JND [%]", "with trend: RMS [mN]",
           "within the JND [%]"});
      last_data = data;
    }
    const BenchRow* query = find(rows, name.substr(0, name.rfind('/')) + "/query");
    print_row({peer, thousands(static_cast<long>(counter("sites"))), duration(fit.seconds),
               query != nullptr ? duration(query->seconds) : "-", fixed(counter("rms_mN"), 1),
               fixed(counter("within_jnd_pct"), 2), fixed(counter("with_trend_rms_mN"), 1),
               fixed(counter("with_trend_within_jnd_pct"), 2)});
    settings.push_back(peer + ": " + fit.label);
  }
  print_settings();
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
  print_ratios(rows);
  print_shares(rows);
  print_against(rows, "Cost over N", "sites, 4-D", kSizeColumns);
  print_against(rows, "Cost over dimension", "features", kDimensionColumns);
  print_peers(rows);
  print_features(rows);
  std::fflush(stdout);
}

}  // namespace palpate::bench
