// What fits cost: against the number of sites (figure 8 of Hoever & Harders 2009)
// and against the dimension (figure 2).
//
// Thread guarantee: slow side.
#pragma once

#include <vector>

#include "models/fit/fit.h"
#include "scenes/report/data/report_data.h"

namespace palpate {

// Every method with its default size on `most` of the sites, or all that there are, and on
// a half, a quarter ... of those, evenly spread. Errors: interrupted; those of fit_method.
Result<std::vector<SitesTime>> time_against_sites(const PreparedTraining& prepared, std::size_t most, int halvings,
                                                  const FitControl& control);

// Direct interpolation, a grid of kNodesPerDimension nodes a side filled from it,
// and greedy with 100 centres, in 1 to `most_dimensions` dimensions. Beyond the
// features that there are, a further dimension holds the values of an earlier one in
// another order: the cost does not depend on them. `most_sites`: of the sites, evenly
// spread. Errors: interrupted; those of the fits.
Result<std::vector<DimensionTime>> time_against_dimension(const Sites& sites, int most_dimensions,
                                                          std::size_t most_sites, const FitControl& control);

inline constexpr int kNodesPerDimension = 10;  // as in the paper's figure 2

}  // namespace palpate
