// The report's tables, from what was measured.
//
// Thread guarantee: pure functions.
#pragma once

#include <string>
#include <vector>

#include "scenes/report/hard/hard_cases.h"
#include "scenes/report/measure/recommendation.h"
#include "scenes/report/data/report_data.h"

namespace palpate {

// All tables; those with a caption are shown on it. Measured
// times are in tables of their own (`Table::has_times`).
std::vector<Table> make_tables(const ReportData& data);

// Those of errors among them (error_tables.cpp).
std::vector<Table> error_tables(const ReportData& data);

// The stability suite's cases as a table for ReportData::hard_cases.
Table hard_case_table(const std::vector<HardCaseResult>& results);

// What to conclude, a sentence each; the first is what every rung of the ladder gains.
// `with_times`: those that rest on measured times.
std::vector<std::string> findings(const ReportData& data, bool with_times);

inline constexpr double kQuick_ns = 1000.0;   // 1 us
inline constexpr double kBudget_ns = 1e6;     // a tick of 1 ms

}  // namespace palpate
