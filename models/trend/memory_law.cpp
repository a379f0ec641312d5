#include "models/trend/memory_law.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace palpate {
namespace {

// At the greatest depth a relaxation time is exp(slowing) times that at the surface: 0.2 to 20.
constexpr std::array kSlowings{0.75, -0.75, 1.5, -1.5, 2.25, 3.0};
// The surface depends on the branches and the branches on the surface: a fixed-point iteration.
constexpr int kSurfacePasses = 2;
// The filters are exact for steps of any length, and a hand moves little in 4 ms.
constexpr double kSearchStep_s = 3.9e-3;
constexpr std::size_t kSearchedTimes = 8;
constexpr std::size_t kSearchedBristles = 2;
// The largest number of identified times; more would be too close together to identify.
constexpr std::size_t kMostTimes = 3;

// At most `most` of the values, evenly spaced by index.
std::vector<double> evenly(const std::vector<double>& values, std::size_t most) {
  if (values.size() <= most) return values;
  std::vector<double> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(values[i * (values.size() - 1) / (most - 1)]);
  return few;
}

// The list with fewer terms, for comparisons of many regressions.
FeatureList shortened(const FeatureList& list) {
  FeatureList few;
  few.add(FeatureKind::maxwell_spectrum, evenly(relaxation_times_s(list.features), kSearchedTimes));
  for (const FeatureSpec& spec : list.features) {
    if (spec.kind == FeatureKind::velocity) few.add(spec.kind);
    if (is_bristle(spec.kind)) few.add(spec.kind, evenly(constants_of(spec), kSearchedBristles));
  }
  return few;
}

FeatureList with_slowing(FeatureList list, double slowing) {
  for (FeatureSpec& spec : list.features) {
    if (is_branch(spec.kind)) spec.slowing = slowing;
  }
  return list;
}

// A shortened list of terms with its slowing and surface, and its cross-validated errors.
struct Law {
  FeatureList list;
  FoldErrors errors;
};

double error_of(const Law& law) { return law.errors.rms_at_mean_score(); }

// The surface_lag and the branches of the trend that is fitted to the rows. Friction and creep do not make the surface
// lag.
std::vector<FeatureSpec> surface_of(const TrendColumns& columns, const TrendWeights& weights) {
  const TrendEstimator estimator(columns, weights, TrendEstimator::Smoothness::fixed);
  const auto without = columns.columns_of([&](std::size_t f) { return !is_bristle(columns.list().features[f].kind); });
  const FittedTrend fitted = fitted_trend(columns, estimator.fit(without), true);
  std::vector<FeatureSpec> surface{surface_lag_of(fitted.trend.elastic, columns.samples().depth_m)};
  std::ranges::copy_if(fitted.features, std::back_inserter(surface), &is_branch, &FeatureSpec::kind);
  return surface;
}

// Scores a law. With `lags` its surface is searched first, beginning with that of `list`, which may have none.
// `samples`: thinned.
Result<Law> scored(const Samples& samples, const TrendWeights& weights, FeatureList list, bool lags,
                   const FitControl& control) {
  for (int pass = 0;; ++pass) {
    const auto columns = TrendColumns::make(samples, list, kSearchRows, control);
    if (!columns) return columns.error();
    if (!lags || pass == kSurfacePasses) {
      const TrendEstimator estimator(*columns, weights, TrendEstimator::Smoothness::fixed);
      return Law{std::move(list), estimator.cross_validate(estimator.all_columns()).errors};
    }
    list.surface = surface_of(*columns, weights);
  }
}

struct SelectedTimes {
  std::vector<int> times;  // indices of the candidates, ascending
  FoldErrors errors;
};

// Adds the time with the lowest RMS error, then moves single times to the next candidate while the error falls.
SelectedTimes with_one_more(const TrendEstimator& estimator, const TrendColumns& rows, const SelectedTimes& last) {
  SelectedTimes best;
  const auto candidates = static_cast<int>(relaxation_times_s(rows.list().features).size());
  const int first = static_cast<int>(rows.list().features.size()) - candidates;
  const auto attempt = [&](std::vector<int> times) {
    std::ranges::sort(times);
    if (std::ranges::adjacent_find(times) != times.end() || times.front() < 0 || times.back() >= candidates) return;
    // Elastic response, viscosity and the branches with these times.
    const auto columns = rows.columns_of([&](std::size_t f) {
      const int time = static_cast<int>(f) - first;
      return time < 0 || std::ranges::binary_search(times, time);
    });
    const FoldErrors errors = estimator.cross_validate(columns).errors;
    if (best.times.empty() || errors.rms() < best.errors.rms()) best = {std::move(times), errors};
  };
  for (int added = 0; added < candidates; ++added) {
    std::vector<int> times = last.times;
    times.push_back(added);
    attempt(std::move(times));
  }
  for (bool moved = !last.times.empty(); moved;) {
    const std::vector<int> from = best.times;
    for (std::size_t i = 0; i < from.size(); ++i) {
      for (const int step : {-1, 1}) {
        std::vector<int> times = from;
        times[i] += step;
        attempt(std::move(times));
      }
    }
    moved = best.times != from;
  }
  return best;
}

}  // namespace

Result<FeatureList> select_memory_law(const Samples& samples, const TrendWeights& weights, const FeatureList& list,
                                      std::vector<PartGain>& gains, const FitControl& control) {
  if (!has_kind(list.features, FeatureKind::maxwell_spectrum)) return list;
  const Samples few = thinned(samples, kSearchStep_s);
  std::vector<Law> surfaces;
  for (const bool lags : {false, true}) {
    auto law = scored(few, weights, shortened(list), lags, control);
    if (!law) return law.error();
    surfaces.push_back(std::move(*law));
  }
  const std::size_t found = simplest_adequate(errors_of(surfaces));
  const bool lags = found == 1;
  gains.push_back({"surface lag", lags, error_of(surfaces[1]), error_of(surfaces[0])});

  std::vector<Law> laws{surfaces[found]};
  for (const double slowing : kSlowings) {
    auto law = scored(few, weights, with_slowing(surfaces[found].list, slowing), lags, control);
    if (!law) return law.error();
    laws.push_back(std::move(*law));
  }
  const std::size_t chosen = simplest_adequate(errors_of(laws));
  const Law& slower =
      chosen != 0 ? laws[chosen] : *std::ranges::min_element(laws.begin() + 1, laws.end(), {}, error_of);
  gains.push_back({"depth-dependent relaxation", chosen != 0, error_of(slower), error_of(laws[0])});
  FeatureList result = with_slowing(list, chosen != 0 ? kSlowings[chosen - 1] : 0.0);
  result.surface = std::move(laws[chosen].list.surface);
  return result;
}

Result<std::vector<double>> identify_relaxation(const Samples& samples, const TrendWeights& weights, bool velocity,
                                                std::size_t count, const FitControl& control) {
  const std::vector<double> candidates_s = dictionary_times_s(samples);
  if (candidates_s.empty()) {
    return Error{
        "the recordings are too short to identify a relaxation time; record for longer, or pass --relaxation scene"};
  }
  const auto rows = TrendColumns::make(samples, single_times(velocity, candidates_s), kSearchRows, control);
  if (!rows) return rows.error();
  const TrendEstimator estimator(*rows, weights, TrendEstimator::Smoothness::fixed);
  SelectedTimes best = with_one_more(estimator, *rows, {});
  while (best.times.size() < std::min(count > 0 ? count : kMostTimes, candidates_s.size())) {
    if (!control.may_continue()) return interrupted();
    SelectedTimes more = with_one_more(estimator, *rows, best);
    if (count == 0 && simplest_adequate(std::vector{best.errors, more.errors}) == 0) break;
    best = std::move(more);
  }
  std::vector<double> times_s;
  for (const int time : best.times) times_s.push_back(candidates_s[static_cast<std::size_t>(time)]);
  return times_s;
}

}  // namespace palpate
