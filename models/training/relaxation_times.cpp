#include "models/training/relaxation_times.h"

#include <algorithm>
#include <utility>

#include "models/training/selection.h"

namespace palpate {
namespace {

// The largest number of times; more would be too close together to identify.
constexpr std::size_t kMostTimes = 3;

// The columns of elastic response, viscosity and the branches with the chosen times.
ColumnList columns_of(const TrendRows& rows, const std::vector<std::size_t>& chosen) {
  ColumnList columns;
  for (std::size_t i = 0; i < rows.first_branch(); ++i) columns.push_back(static_cast<Eigen::Index>(i));
  for (const std::size_t time : chosen) {
    for (std::size_t k = 0; k < kBranchTerms; ++k) {
      columns.push_back(static_cast<Eigen::Index>(rows.first_branch() + time * kBranchTerms + k));
    }
  }
  return columns;
}

struct Choice {
  std::vector<std::size_t> times;  // of the ladder, ascending
  CrossValidated error;
};

// Adds the time with the lowest RMS error, then moves single times by one step of the ladder while the error falls.
Choice with_one_more(const TrendRegression& regression, const TrendRows& rows, const Choice& last) {
  Choice best;
  const std::size_t ladder = rows.relaxation_times_s().size();
  const auto attempt = [&](std::vector<std::size_t> times) {
    std::sort(times.begin(), times.end());
    if (std::adjacent_find(times.begin(), times.end()) != times.end() || times.back() >= ladder) return;
    Choice one{std::move(times), CrossValidated{}};
    one.error = regression.cross_validate(columns_of(rows, one.times));
    if (best.times.empty() || one.error.errors.rms() < best.error.errors.rms()) best = std::move(one);
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

Result<std::vector<double>> identify_relaxation(MotionSource& source, const TrendProblem& problem,
                                                const TrainingExtent& extent, bool velocity, std::size_t count,
                                                const FitControl& control, double fraction) {
  FeatureList list = dictionary(extent.sample_s, extent.longest_recording_s, problem.reference_depth_m, 0.0);
  list.velocity = velocity;
  list.stop_thresholds_m.clear();
  list.creep_times_s.clear();
  const auto rows = gather_rows(source, list, problem, kSearchedRows, 0.0, control, fraction);
  if (!rows) return rows.error();
  const auto& ladder_s = rows->relaxation_times_s();
  if (ladder_s.empty()) {
    return Error{
        "the recordings are too short to identify a relaxation time; record for longer, or pass --relaxation scene"};
  }
  const TrendRegression regression(*rows, source.folds(), problem, TrendRegression::Smoothness::fixed);
  Choice best = with_one_more(regression, *rows, {{}, regression.cross_validate(columns_of(*rows, {}))});
  while (best.times.size() < std::min(count > 0 ? count : kMostTimes, ladder_s.size())) {
    if (!control.may_continue(fraction)) return interrupted();
    Choice more = with_one_more(regression, *rows, best);
    const FoldErrors candidates[] = {best.error.errors, more.error.errors};
    if (count == 0 && simplest_adequate(candidates) == 0) break;
    best = std::move(more);
  }
  std::vector<double> times_s;
  for (const std::size_t time : best.times) times_s.push_back(ladder_s[time]);
  return times_s;
}

}  // namespace palpate
