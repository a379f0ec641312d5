#include "models/training/memory_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "models/training/cross_validated_trend.h"
#include "models/training/fit_trend.h"
#include "models/training/trend_rows.h"

namespace palpate {
namespace {

constexpr std::size_t kLawRows = 4000;
// A fifth to twenty times as long at the greatest depth as at the surface.
constexpr std::array kSlowings{-1.5, 1.5, 3.0};
constexpr double kSlowingStep = 0.75;  // both sides of the best of them
constexpr double kLeastLawGain = 0.03;  // of the mean square
constexpr int kSurfacePasses = 2;
// The filters are exact for steps of any length; a hand moves little in 4 ms.
constexpr double kLawStep_s = 3.9e-3;

// At most `most` of the values, evenly; of them all the middle one.
std::vector<double> evenly(const std::vector<double>& values, std::size_t most) {
  if (values.size() <= most) return values;
  if (most == 1) return {values[values.size() / 2]};
  std::vector<double> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(values[i * (values.size() - 1) / (most - 1)]);
  return few;
}

struct Answer {
  MemoryLaw law;
  CrossValidation error;
  std::vector<FeatureSpec> fitted;  // where this fit would have the surface
};

class LawSearch {
 public:
  LawSearch(MotionSource& source, const FoldDealer& dealer, const SelectionInput& input, const TrendTerms& ladder,
            const FitControl& control, double fraction)
      : source_(source),
        dealer_(dealer),
        input_(input),
        times_s_(evenly(ladder.relaxation_times_s, kMaxFeatureParts)),
        other_{ladder.reference_depth_m, 0.0, {}, evenly(ladder.stop_thresholds_m, 2), evenly(ladder.peak_times_s, 1)},
        control_(control),
        fraction_(fraction) {}

  Result<Answer> fit(const MemoryLaw& law) const {
    TrendTerms terms{input_.reference_depth_m, input_.rms_velocity_m_per_s, times_s_, other_.stop_thresholds_m,
                     other_.peak_times_s};
    terms.slowing = law.slowing;
    terms.spline_elastic = true;
    terms.surface = law.surface;
    TrendRows rows(std::move(terms), kLawRows);
    FoldDealer folds = dealer_;
    double last_s = 0.0;
    const Status status = source_.for_each([&](const MotionRow& row) {
      if (row.first) rows.begin_recording();
      const int fold = folds.next(row);
      if (!row.first && row.sample.time_s - last_s < kLawStep_s) return true;
      last_s = row.sample.time_s;
      if (row.run_up) rows.advance(row.sample, row.motion);
      else rows.add(row.sample, row.motion, row.force_N, fold);
      return true;
    }, control_, fraction_);
    if (!status) return status.error();
    const CrossValidatedTrend problem(rows, dealer_.folds(), input_.weighting, input_.jnd, input_.force_floor_N);
    ColumnList all(rows.columns());
    std::iota(all.begin(), all.end(), Eigen::Index{0});
    Answer answer{law, problem.left_out(all), {}};
    // Friction and softening hold no surface back.
    all.resize(rows.first_stop());
    answer.fitted = surface_of(rows, problem.solve(all));
    return answer;
  }

 private:
  std::vector<FeatureSpec> surface_of(const TrendRows& rows, const Eigen::VectorXd& x) const {
    FeatureSpec lag{FeatureKind::surface_lag};
    lag.drive = combined_spline(x.data(), rows.reference_depth_m());
    FeatureSpec spectrum;
    spectrum.kind = FeatureKind::maxwell_spectrum;
    spectrum.slowing = rows.terms().slowing;
    spectrum.part_count = times_s_.size();
    for (std::size_t t = 0; t < times_s_.size(); ++t) {
      const double* weights = x.data() + rows.first_branch() + t * kBranchTerms;
      spectrum.parts[t] = {times_s_[t], 0.0, combined_drive(weights, rows.reference_depth_m())};
    }
    return {lag, spectrum};
  }

  MotionSource& source_;
  const FoldDealer& dealer_;
  const SelectionInput& input_;
  std::vector<double> times_s_;
  TrendTerms other_;  // friction and softening, so that neither is taken for memory
  const FitControl& control_;
  double fraction_;
};

bool is_better(const Answer& a, const Answer& b) {
  const double gain = b.error.mean() - a.error.mean();
  return gain > kLeastLawGain * b.error.mean() && gain > a.error.standard_error_against(b.error);
}

}  // namespace

Result<MemoryLaw> find_memory_law(MotionSource& source, const FoldDealer& dealer, const SelectionInput& input,
                                  const TrendTerms& ladder, const FitControl& control, double fraction) {
  if (ladder.relaxation_times_s.empty()) return MemoryLaw{};
  const LawSearch search(source, dealer, input, ladder, control, fraction);
  auto best = search.fit({});
  if (!best) return best.error();
  double best_other = std::numeric_limits<double>::infinity();  // of the answers to one question
  // Fits that answer, from the surface of an answer near it, and keeps the better one.
  const auto attempt = [&](double slowing, bool lags, std::vector<FeatureSpec> surface, int passes) -> Status {
    for (int pass = 0; pass < passes; ++pass) {
      auto answer = search.fit({slowing, lags ? surface : std::vector<FeatureSpec>{}});
      if (!answer) return answer.error();
      surface = answer->fitted;
      if (pass + 1 == passes) best_other = std::min(best_other, answer->error.mean());
      if (pass + 1 == passes && is_better(*answer, *best)) best = std::move(answer);
    }
    return {};
  };
  const double plain = best->error.mean();
  if (Status status = attempt(0.0, true, best->fitted, kSurfacePasses); !status) return status.error();
  const bool lags = !best->law.surface.empty();
  const FeatureWorth lag_worth{"surface that lags", lags, std::sqrt(best_other), std::sqrt(plain)};
  const double constant_times = best->error.mean();
  best_other = std::numeric_limits<double>::infinity();
  const auto slowed = [&](double slowing) { return attempt(slowing, lags, best->fitted, lags ? kSurfacePasses : 1); };
  for (const double slowing : kSlowings) {
    if (Status status = slowed(slowing); !status) return status.error();
  }
  if (const double coarse = best->law.slowing; coarse != 0.0) {
    for (const double slowing : {coarse - kSlowingStep, coarse + kSlowingStep}) {
      if (Status status = slowed(slowing); !status) return status.error();
    }
    if (!lags) {
      if (Status status = attempt(best->law.slowing, true, best->fitted, kSurfacePasses); !status) return status.error();
    }
  }
  best->law.worth = {lag_worth, {"slower when deeper", best->law.slowing != 0.0, std::sqrt(best_other), std::sqrt(constant_times)}};
  return best->law;
}

}  // namespace palpate
