#include "models/training/memory_law.h"

#include <algorithm>
#include <array>
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

// At most `most` of the values, evenly spaced by index.
std::vector<double> evenly(const std::vector<double>& values, std::size_t most) {
  if (values.size() <= most) return values;
  std::vector<double> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(values[i * (values.size() - 1) / (most - 1)]);
  return few;
}

// The list with fewer terms, for comparisons of many regressions.
FeatureList shortened(FeatureList list) {
  if (!list.relaxation_times_s.empty()) list.relaxation_times_s = {evenly(list.all_times_s(), kSearchedTimes)};
  list.stop_thresholds_m = evenly(list.stop_thresholds_m, kSearchedBristles);
  list.creep_times_s = evenly(list.creep_times_s, kSearchedBristles);
  return list;
}

// The laws that were tried, from the simplest to the most complex, with their errors. Each is the shortened list of
// terms with its slowing and surface.
struct Tried {
  std::vector<FeatureList> laws{};
  std::vector<FoldErrors> errors{};
};

class LawSearch {
 public:
  LawSearch(MotionSource& source, const TrendProblem& problem, const FitControl& control, double fraction)
      : source_(source), problem_(problem), control_(control), fraction_(fraction) {}

  // Adds the law to those tried. With `lags` its surface is searched first, beginning with that of the law, which may
  // have none; the surface that is scored is the one of the law.
  Status add(Tried& tried, FeatureList law, bool lags) const {
    for (int pass = 0; lags && pass < kSurfacePasses; ++pass) {
      const auto rows = rows_of(law);
      if (!rows) return rows.error();
      const TrendRegression regression(*rows, TrendRegression::Smoothness::fixed);
      ColumnList columns = regression.all_columns();
      columns.resize(rows->first_stop());  // friction and creep do not make the surface lag
      law.surface = surface_of(*rows, regression.solve(columns));
    }
    const auto rows = rows_of(law);
    if (!rows) return rows.error();
    const TrendRegression regression(*rows, TrendRegression::Smoothness::fixed);
    tried.errors.push_back(regression.cross_validate(regression.all_columns()).errors);
    tried.laws.push_back(std::move(law));
    return {};
  }

 private:
  Result<TrendRows> rows_of(const FeatureList& law) const {
    return gather_rows(source_, law, problem_, kSearchRows, kSearchStep_s, control_, fraction_);
  }

  static std::vector<FeatureSpec> surface_of(const TrendRows& rows, const Eigen::VectorXd& x) {
    const FittedTrend fitted = fitted_trend(rows, x, true);
    FeatureSpec lag{FeatureKind::surface_lag};
    lag.drive = coarse_curve(fitted.trend.elastic, rows.problem().reference_depth_m);
    std::vector<FeatureSpec> surface{lag};
    for (const FeatureSpec& spec : fitted.features) {
      if (is_branch(spec.kind)) surface.push_back(spec);
    }
    return surface;
  }

  MotionSource& source_;
  const TrendProblem& problem_;
  const FitControl& control_;
  double fraction_;
};

// The largest number of times; more would be too close together to identify.
constexpr std::size_t kMostTimes = 3;

// The columns of elastic response, viscosity and the branches with the chosen times.
ColumnList columns_of(const TrendRows& rows, const std::vector<std::size_t>& chosen) {
  ColumnList columns = columns_from(0, rows.first_branch());
  for (const std::size_t time : chosen) {
    const ColumnList branch = columns_from(rows.first_branch() + time * kCurveTerms, kCurveTerms);
    columns.insert(columns.end(), branch.begin(), branch.end());
  }
  return columns;
}

struct Choice {
  std::vector<std::size_t> times;  // of the ladder, ascending
  FoldErrors errors;
};

// Adds the time with the lowest RMS error, then moves single times by one step of the ladder while the error falls.
Choice with_one_more(const TrendRegression& regression, const TrendRows& rows, const Choice& last) {
  Choice best;
  const std::size_t ladder = rows.list().all_times_s().size();
  const auto attempt = [&](std::vector<std::size_t> times) {
    std::sort(times.begin(), times.end());
    if (std::adjacent_find(times.begin(), times.end()) != times.end() || times.back() >= ladder) return;
    const FoldErrors errors = regression.cross_validate(columns_of(rows, times)).errors;
    if (best.times.empty() || errors.rms() < best.errors.rms()) best = {std::move(times), errors};
  };
  for (std::size_t added = 0; added < ladder; ++added) {
    std::vector<std::size_t> times = last.times;
    times.push_back(added);
    attempt(times);
  }
  for (bool moved = !last.times.empty(); moved;) {
    const std::vector<std::size_t> from = best.times;
    for (std::size_t i = 0; i < from.size(); ++i) {
      for (const int step : {-1, 1}) {
        if (step < 0 && from[i] == 0) continue;
        std::vector<std::size_t> times = from;
        times[i] = step < 0 ? times[i] - 1 : times[i] + 1;
        attempt(times);
      }
    }
    moved = best.times != from;
  }
  return best;
}

}  // namespace

Result<FoldErrors> simple_law_error(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                                    const FitControl& control, double fraction) {
  Tried tried;
  const LawSearch search(source, problem, control, fraction);
  if (Status status = search.add(tried, shortened(list), false); !status) return status.error();
  return tried.errors.front();
}

Result<FeatureList> select_memory_law(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                                      std::vector<PartGain>& gains, const FitControl& control, double fraction) {
  if (list.relaxation_times_s.empty()) return list;
  const LawSearch search(source, problem, control, fraction);
  Tried surface;
  for (const bool lags : {false, true}) {
    if (Status status = search.add(surface, shortened(list), lags); !status) return status.error();
  }
  const std::size_t found = simplest_adequate(surface.errors);
  const bool lags = found == 1;
  gains.push_back({"surface lag", lags, surface.errors[1].rms_at_mean_score(), surface.errors[0].rms_at_mean_score()});

  Tried slower{{surface.laws[found]}, {surface.errors[found]}};
  for (const double slowing : kSlowings) {
    FeatureList law = surface.laws[found];
    law.slowing = slowing;
    if (Status status = search.add(slower, std::move(law), lags); !status) return status.error();
  }
  const std::size_t chosen = simplest_adequate(slower.errors);
  std::vector<double> errors;
  for (const FoldErrors& one : slower.errors) errors.push_back(one.rms_at_mean_score());
  gains.push_back({"depth-dependent relaxation", chosen != 0,
                   chosen != 0 ? errors[chosen] : *std::min_element(errors.begin() + 1, errors.end()), errors[0]});
  FeatureList result = list;
  result.slowing = slower.laws[chosen].slowing;
  result.surface = std::move(slower.laws[chosen].surface);
  return result;
}

Result<std::vector<double>> identify_relaxation(MotionSource& source, const TrendProblem& problem,
                                                const TrainingExtent& extent, bool velocity, std::size_t count,
                                                const FitControl& control, double fraction) {
  FeatureList list = dictionary(extent.sample_s, extent.longest_recording_s, problem.reference_depth_m, 0.0);
  list.velocity = velocity;
  list.stop_thresholds_m.clear();
  list.creep_times_s.clear();
  const auto rows = gather_rows(source, list, problem, kSearchRows, 0.0, control, fraction);
  if (!rows) return rows.error();
  const std::vector<double> ladder_s = rows->list().all_times_s();
  if (ladder_s.empty()) {
    return Error{
        "the recordings are too short to identify a relaxation time; record for longer, or pass --relaxation scene"};
  }
  const TrendRegression regression(*rows, TrendRegression::Smoothness::fixed);
  Choice best = with_one_more(regression, *rows, {{}, regression.cross_validate(columns_of(*rows, {})).errors});
  while (best.times.size() < std::min(count > 0 ? count : kMostTimes, ladder_s.size())) {
    if (!control.may_continue(fraction)) return interrupted();
    Choice more = with_one_more(regression, *rows, best);
    const FoldErrors candidates[] = {best.errors, more.errors};
    if (count == 0 && simplest_adequate(candidates) == 0) break;
    best = std::move(more);
  }
  std::vector<double> times_s;
  for (const std::size_t time : best.times) times_s.push_back(ladder_s[time]);
  return times_s;
}

}  // namespace palpate
