// All numbers of a report as tables.
//
// Thread guarantee: pure function.
#pragma once

#include <vector>

#include "scenes/report/report_data.h"
#include "scenes/report/table.h"

namespace palpate {

// models, recordings, force_bins, features, times; those with times differ from run to run.
std::vector<Table> make_tables(const ReportData& data);

}  // namespace palpate
