#include "models/training/slowing.h"

#include <algorithm>
#include <array>

#include "models/training/selection.h"

namespace palpate {
namespace {

// At the greatest depth a relaxation time is exp(slowing) times that at the surface: 0.2 to 20.
constexpr std::array kSlowings{0.0, 0.75, -0.75, 1.5, -1.5, 2.25, 3.0};
// The filters are exact for steps of any length, and a hand moves little in 4 ms.
constexpr double kSearchStep_s = 3.9e-3;
constexpr std::size_t kSearchedTimes = 8;
constexpr std::size_t kSearchedBristles = 2;

// At most `most` of the values, evenly.
std::vector<double> evenly(const std::vector<double>& values, std::size_t most) {
  if (values.size() <= most) return values;
  std::vector<double> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(values[i * (values.size() - 1) / (most - 1)]);
  return few;
}

}  // namespace

Result<FeatureList> select_slowing(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                                   std::vector<PartGain>& gains, const FitControl& control, double fraction) {
  if (all_times(list).empty()) return list;
  FeatureList few = list;
  few.relaxation_times_s = {evenly(all_times(list), kSearchedTimes)};
  few.stop_thresholds_m = evenly(list.stop_thresholds_m, kSearchedBristles);
  few.creep_times_s = evenly(list.creep_times_s, kSearchedBristles);
  std::vector<FoldErrors> errors;
  for (const double slowing : kSlowings) {
    few.slowing = slowing;
    const auto rows = gather_rows(source, few, problem, kSearchedRows, kSearchStep_s, control, fraction);
    if (!rows) return rows.error();
    const TrendRegression regression(*rows, source.folds(), problem, TrendRegression::Smoothness::fixed);
    errors.push_back(regression.cross_validate(regression.all_columns()).errors);
  }
  const std::size_t chosen = simplest_adequate(errors);
  const auto best_other = std::min_element(errors.begin() + 1, errors.end(),
                                           [](const auto& a, const auto& b) { return a.rms() < b.rms(); });
  const bool slows = kSlowings[chosen] != 0.0;
  gains.push_back({"slower when deeper", slows, slows ? errors[chosen].rms() : best_other->rms(), errors[0].rms()});
  FeatureList found = list;
  found.slowing = kSlowings[chosen];
  return found;
}

}  // namespace palpate
