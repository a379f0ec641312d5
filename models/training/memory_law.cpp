#include "models/training/memory_law.h"

#include <algorithm>
#include <array>
#include <utility>

#include "models/training/selection.h"

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

struct Law {
  double slowing = 0.0;
  std::vector<FeatureSpec> surface{};  // FeatureList::surface
};

// The laws that were tried, from the simplest to the most complex, with their errors.
struct Tried {
  std::vector<Law> laws{};
  std::vector<FoldErrors> errors{};

  std::size_t best() const { return simplest_adequate(errors); }
  // The lowest error of the laws `first` to `last` - 1.
  double lowest_error(std::size_t first, std::size_t last) const {
    double lowest = errors[first].rms_at_mean_score();
    for (std::size_t i = first + 1; i < last; ++i) lowest = std::min(lowest, errors[i].rms_at_mean_score());
    return lowest;
  }
};

class LawSearch {
 public:
  LawSearch(MotionSource& source, const FeatureList& list, const TrendProblem& problem, const FitControl& control,
            double fraction)
      : source_(source), list_(list), problem_(problem), control_(control), fraction_(fraction) {
    list_.relaxation_times_s = {evenly(all_times(list), kSearchedTimes)};
    list_.stop_thresholds_m = evenly(list.stop_thresholds_m, kSearchedBristles);
    list_.creep_times_s = evenly(list.creep_times_s, kSearchedBristles);
  }

  // Adds the law to those tried. With `lags` its surface is searched first, beginning with that of the law, which may
  // have none; the surface that is scored is the one of the law.
  Status add(Tried& tried, Law law, bool lags) const {
    for (int pass = 0; lags && pass < kSurfacePasses; ++pass) {
      const auto rows = rows_of(law);
      if (!rows) return rows.error();
      const TrendRegression regression(*rows, source_.folds(), problem_, TrendRegression::Smoothness::fixed);
      ColumnList columns = regression.all_columns();
      columns.resize(rows->first_stop());  // friction and creep do not make the surface lag
      law.surface = surface_of(*rows, regression.solve(columns));
    }
    const auto rows = rows_of(law);
    if (!rows) return rows.error();
    const TrendRegression regression(*rows, source_.folds(), problem_, TrendRegression::Smoothness::fixed);
    tried.errors.push_back(regression.cross_validate(regression.all_columns()).errors);
    tried.laws.push_back(std::move(law));
    return {};
  }

 private:
  Result<TrendRows> rows_of(const Law& law) const {
    FeatureList list = list_;
    list.slowing = law.slowing;
    list.surface = law.surface;
    return gather_rows(source_, list, problem_, kSearchedRows, kSearchStep_s, control_, fraction_);
  }

  std::vector<FeatureSpec> surface_of(const TrendRows& rows, const Eigen::VectorXd& x) const {
    FeatureList list = list_;
    list.slowing = rows.terms().slowing;
    const FittedTrend fitted = fitted_trend(list, rows, x, true);
    FeatureSpec lag{FeatureKind::surface_lag};
    lag.drive = coarse_curve(fitted.trend.elastic, rows.reference_depth_m());
    std::vector<FeatureSpec> surface{lag};
    for (const FeatureSpec& spec : fitted.features) {
      if (is_branch(spec.kind)) surface.push_back(spec);
    }
    return surface;
  }

  MotionSource& source_;
  FeatureList list_;
  const TrendProblem& problem_;
  const FitControl& control_;
  double fraction_;
};

}  // namespace

Result<FoldErrors> simple_law_error(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                                    const FitControl& control, double fraction) {
  Tried tried;
  if (Status status = LawSearch(source, list, problem, control, fraction).add(tried, {}, false); !status) {
    return status.error();
  }
  return tried.errors.front();
}

Result<FeatureList> select_memory_law(MotionSource& source, const FeatureList& list, const TrendProblem& problem,
                                      std::vector<PartGain>& gains, const FitControl& control, double fraction) {
  if (all_times(list).empty()) return list;
  const LawSearch search(source, list, problem, control, fraction);
  Tried surface;
  if (Status status = search.add(surface, {}, false); !status) return status.error();
  if (Status status = search.add(surface, {}, true); !status) return status.error();
  const std::size_t found = surface.best();
  const bool lags = found == 1;
  gains.push_back({"surface lag", lags, surface.errors[1].rms_at_mean_score(), surface.errors[0].rms_at_mean_score()});

  Tried slower{{surface.laws[found]}, {surface.errors[found]}};
  for (const double slowing : kSlowings) {
    if (Status status = search.add(slower, {slowing, surface.laws[found].surface}, lags); !status) {
      return status.error();
    }
  }
  const std::size_t chosen = slower.best();
  gains.push_back(
      {"depth-dependent relaxation", chosen != 0,
       chosen != 0 ? slower.errors[chosen].rms_at_mean_score() : slower.lowest_error(1, slower.errors.size()),
       slower.errors[0].rms_at_mean_score()});
  FeatureList result = list;
  result.slowing = slower.laws[chosen].slowing;
  result.surface = std::move(slower.laws[chosen].surface);
  return result;
}

}  // namespace palpate
