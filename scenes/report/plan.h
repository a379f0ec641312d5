// Which models a report fits.
//
// Thread guarantee: pure functions.
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/report/report_data.h"

namespace palpate {

struct ReportPlan {
  std::vector<PlannedModel> models;    // the main ones first, a method's base before it
  std::vector<PlannedModel> repeated;  // once per seed
  std::vector<std::uint64_t> seeds;    // at least ten
  std::vector<std::size_t> site_counts;  // for fit time against sites; those above the data's are left out
  int most_dimensions = 0;
  std::size_t dimension_sites = 0;  // at most, for cost against the dimension
};

// `features`: of the scene, 1 to 8.
ReportPlan make_plan(bool quick, std::size_t features);

}  // namespace palpate
