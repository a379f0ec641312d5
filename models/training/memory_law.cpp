#include "models/training/memory_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "models/training/acceptance.h"

namespace palpate {
namespace {

// A fifth to twenty times as long at the greatest depth as at the surface.
constexpr std::array kSlowings{-1.5, 1.5, 3.0};
constexpr double kSlowingStep = 0.75;  // both sides of the best of them
// Where the surface is depends on the branches, and these on where it is.
constexpr int kSurfacePasses = 2;
// The filters are exact for steps of any length; a hand moves little in 4 ms.
constexpr double kLawStep_s = 3.9e-3;

// At most `most` of the values, evenly; of them all the middle one.
std::vector<double> evenly(const std::vector<double>& values, std::size_t most) {
  if (values.size() <= most) return values;
  std::vector<double> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(values[i * (values.size() - 1) / (most - 1)]);
  return few;
}

struct Law {
  double slowing = 0.0;
  bool lags = false;
};

struct Answer {
  Law law;
  LeftOutTrend error;
  std::vector<FeatureSpec> surface;  // where this fit would have it
};

class LawSearch {
 public:
  LawSearch(MotionSource& source, const FoldDealer& dealer, const FeatureList& list, const TrendProblem& problem,
            const FitControl& control, double fraction)
      : source_(source), dealer_(dealer), list_(list), problem_(problem), control_(control), fraction_(fraction) {
    list_.relaxation_times_s = {evenly(all_times(list), kMaxFeatureParts)};
    list_.stop_thresholds_m = evenly(list.stop_thresholds_m, 2);
    list_.creep_times_s = evenly(list.creep_times_s, 2);
  }

  // From the surface of an answer near it.
  Result<Answer> fit(const Law& law, std::vector<FeatureSpec> surface) const {
    Answer answer;
    for (int pass = 0; pass < (law.lags ? kSurfacePasses : 1); ++pass) {
      FeatureList list = list_;
      list.slowing = law.slowing;
      if (law.lags) list.surface = std::move(surface);
      const auto rows = gather_rows(source_, dealer_, list, problem_, kSearchedRows, kLawStep_s, control_, fraction_);
      if (!rows) return rows.error();
      const TrendRegression regression(*rows, dealer_.folds(), problem_.weighting, problem_.jnd,
                                       problem_.force_noise_floor_N);
      ColumnList held = regression.all_columns();
      answer = {law, regression.left_out(held), {}};
      held.resize(rows->first_stop());  // friction and creep hold no surface back
      surface = surface_of(fitted_trend(list, *rows, regression.solve(held), true), *rows, regression.solve(held));
      answer.surface = surface;
    }
    return answer;
  }

 private:
  static std::vector<FeatureSpec> surface_of(const FittedTrend& fitted, const TrendRows& rows,
                                             const Eigen::VectorXd& x) {
    FeatureSpec lag{FeatureKind::surface_lag};
    lag.drive = combined_spline(x.data(), rows.reference_depth_m());
    std::vector<FeatureSpec> surface{lag};
    for (const FeatureSpec& spec : fitted.features) {
      if (is_branch(spec.kind)) surface.push_back(spec);
    }
    return surface;
  }

  MotionSource& source_;
  const FoldDealer& dealer_;
  FeatureList list_;
  const TrendProblem& problem_;
  const FitControl& control_;
  double fraction_;
};

// Keeps the better of several answers to one question.
struct Question {
  Result<Answer>& best;
  double best_other = -1.0;  // RMS of the best other answer

  Status ask(const LawSearch& search, const Law& law) {
    auto answer = search.fit(law, best->surface);
    if (!answer) return answer.error();
    const double rms = answer->error.rms();
    if (best_other < 0.0 || rms < best_other) best_other = rms;
    if (is_worth_it(answer->error.fold_error, best->error.fold_error)) best = std::move(answer);
    return {};
  }
};

}  // namespace

Result<TrendRows> gather_rows(MotionSource& source, const FoldDealer& dealer, const FeatureList& list,
                              const TrendProblem& problem, std::size_t most_rows, double least_step_s,
                              const FitControl& control, double fraction) {
  TrendRows rows(terms_of(list, problem.reference_depth_m, problem.rms_velocity_m_per_s), most_rows);
  FoldDealer folds = dealer;
  double last_s = 0.0;
  const Status status = source.for_each(
      [&](const MotionRow& row) {
        if (row.first) rows.begin_recording();
        const int fold = folds.next(row);
        if (!row.first && row.sample.time_s - last_s < least_step_s) return true;
        last_s = row.sample.time_s;
        if (row.run_up)
          rows.advance(row.sample, row.motion);
        else
          rows.add(row.sample, row.motion, row.force_N, fold);
        return true;
      },
      control, fraction);
  if (!status) return status.error();
  return rows;
}

Result<FeatureList> find_memory_law(MotionSource& source, const FoldDealer& dealer, const FeatureList& list,
                                    const TrendProblem& problem, std::vector<FeatureWorth>& worth,
                                    const FitControl& control, double fraction) {
  if (all_times(list).empty()) return list;
  const LawSearch search(source, dealer, list, problem, control, fraction);
  auto best = search.fit({}, {});
  if (!best) return best.error();
  const double plain = best->error.rms();
  Question lag{best};
  if (Status status = lag.ask(search, {0.0, true}); !status) return status.error();
  worth.push_back({"surface that lags", best->law.lags, lag.best_other, plain});
  const double constant_times = best->error.rms();
  Question slower{best};
  for (const double slowing : kSlowings) {
    if (Status status = slower.ask(search, {slowing, best->law.lags}); !status) return status.error();
  }
  if (const double coarse = best->law.slowing; coarse != 0.0) {
    for (const double slowing : {coarse - kSlowingStep, coarse + kSlowingStep}) {
      if (Status status = slower.ask(search, {slowing, best->law.lags}); !status) return status.error();
    }
    if (!best->law.lags) {
      if (Status status = lag.ask(search, {best->law.slowing, true}); !status) return status.error();
      worth.back().taken = best->law.lags;
    }
  }
  worth.push_back({"slower when deeper", best->law.slowing != 0.0, slower.best_other, constant_times});
  FeatureList found = list;
  found.slowing = best->law.slowing;
  if (best->law.lags) found.surface = best->surface;
  return found;
}

}  // namespace palpate
