#include "models/training/relaxation.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "models/training/fit_trend.h"
#include "models/training/trend_rows.h"

namespace palpate {
namespace {

constexpr std::size_t kMaximumTimes = 3;
constexpr std::size_t kFolds = 5;
// Strokes are dealt to the folds in turn; longer ones in pieces.
constexpr std::size_t kLongestPiece = 3000;
constexpr double kShortestTime_s = 0.01;
constexpr double kLongestTime_s = 10.0;
constexpr std::size_t kLadder = 24;    // 0.01 to 10 s in steps of 35 %
constexpr int kFineSteps = 4;          // to each side, within one coarse step
constexpr int kOneSidedPasses = 4;
// The fewest times within this of the best cross-validated error are taken.
constexpr double kWorthwhile = 1.05;
constexpr std::size_t kMinimumRows = 50;

struct TimeEquations {
  Eigen::MatrixXd gram;
  Eigen::VectorXd right_side;
  double squares = 0.0;  // sum of (s f)^2
  double count = 0.0;

  TimeEquations operator-(const TimeEquations& other) const {
    return {gram - other.gram, right_side - other.right_side, squares - other.squares, count - other.count};
  }
  TimeEquations part(const std::vector<Eigen::Index>& columns) const {
    return {gram(columns, columns), right_side(columns), squares, count};
  }
  double residual(const Eigen::VectorXd& x) const {
    return std::max(0.0, squares - 2.0 * right_side.dot(x) + x.dot(gram * x));
  }
};

// The regression on a set of times, with its Gram matrix per fold.
class Problem {
 public:
  Problem(TrendRows rows, Weighting weighting, const JndLine& jnd, double force_noise_floor_N)
      : rows_(std::move(rows)), fixed_(static_cast<Eigen::Index>(rows_.columns() -
                                       kBranchTerms * rows_.relaxation_times_s().size())) {
    std::vector<char> active(rows_.count(), 1);
    for (int pass = 0; pass < kOneSidedPasses; ++pass) {
      assemble(active, weighting, jnd);
      // All times together: a non-negative relaxation spectrum, good enough to
      // tell where the tool outran the material.
      const Eigen::VectorXd x = solve_non_negative(total_.gram, total_.right_side);
      for (std::size_t i = 0; i < rows_.count(); ++i) {
        if (rows_.force_N(i) > force_noise_floor_N) continue;
        active[i] = Eigen::Map<const Eigen::VectorXd>(rows_.row(i), x.size()).dot(x) > 0.0 ? 1 : 0;
      }
    }
    assemble(active, weighting, jnd);
  }

  const std::vector<double>& times_s() const { return rows_.relaxation_times_s(); }
  const TimeEquations& total() const { return total_; }
  TimeEquations without(std::size_t fold) const { return total_ - folds_[fold]; }

  std::vector<Eigen::Index> columns(const std::vector<std::size_t>& chosen) const {
    std::vector<Eigen::Index> result;
    for (Eigen::Index i = 0; i < fixed_; ++i) result.push_back(i);
    for (const std::size_t time : chosen) {
      for (std::size_t k = 0; k < kBranchTerms; ++k) {
        result.push_back(fixed_ + static_cast<Eigen::Index>(time * kBranchTerms + k));
      }
    }
    return result;
  }

  double residual(const TimeEquations& equations, const std::vector<std::size_t>& chosen) const {
    const TimeEquations part = equations.part(columns(chosen));
    return part.residual(solve_non_negative(part.gram, part.right_side));
  }

  // Sum of squares on `fold` of the solution without it.
  double left_out(std::size_t fold, const std::vector<std::size_t>& chosen) const {
    const auto index = columns(chosen);
    const TimeEquations train = without(fold).part(index);
    return folds_[fold].part(index).residual(solve_non_negative(train.gram, train.right_side));
  }

 private:
  void assemble(const std::vector<char>& active, Weighting weighting, const JndLine& jnd) {
    const auto n = static_cast<Eigen::Index>(rows_.columns());
    total_ = {Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0, 0.0};
    folds_.fill(total_);
    std::size_t begin = 0;
    std::size_t piece = 0;
    while (begin < rows_.count()) {
      std::size_t end = begin;
      while (end < rows_.count() && rows_.stroke(end) == rows_.stroke(begin) && end - begin < kLongestPiece) ++end;
      add_piece(folds_[piece++ % kFolds], begin, end, active, weighting, jnd);
      begin = end;
    }
    for (const TimeEquations& fold : folds_) {
      total_.gram += fold.gram;
      total_.right_side += fold.right_side;
      total_.squares += fold.squares;
      total_.count += fold.count;
    }
  }

  void add_piece(TimeEquations& fold, std::size_t begin, std::size_t end, const std::vector<char>& active,
                 Weighting weighting, const JndLine& jnd) {
    std::vector<std::size_t> index;
    for (std::size_t i = begin; i < end; ++i) {
      if (active[i]) index.push_back(i);
    }
    if (index.empty()) return;
    const auto n = static_cast<Eigen::Index>(rows_.columns());
    const auto m = static_cast<Eigen::Index>(index.size());
    Eigen::MatrixXd columns(n + 1, m);  // the basis and, last, the force
    for (Eigen::Index k = 0; k < m; ++k) {
      const std::size_t i = index[static_cast<std::size_t>(k)];
      const double scale = row_scale(weighting, jnd, rows_.force_N(i));
      columns.col(k).head(n) = scale * Eigen::Map<const Eigen::VectorXd>(rows_.row(i), n);
      columns(n, k) = scale * rows_.force_N(i);
    }
    fold.gram.noalias() += columns.topRows(n) * columns.topRows(n).transpose();
    fold.right_side.noalias() += columns.topRows(n) * columns.row(n).transpose();
    fold.squares += columns.row(n).squaredNorm();
    fold.count += static_cast<double>(m);
  }

  TrendRows rows_;
  Eigen::Index fixed_;
  TimeEquations total_;
  std::array<TimeEquations, kFolds> folds_;
};

Result<TrendRows> gather(MotionSource& source, double depth_m, double thinning_velocity_m_per_s,
                         std::vector<double> times_s, const FitControl& control, double fraction) {
  TrendRows rows(depth_m, thinning_velocity_m_per_s, std::move(times_s));
  std::size_t seen = 0;
  const Status status = source.for_each([&](const MotionRow& row) {
    if (row.first) rows.begin_recording();
    rows.add(row.sample, row.motion, row.force_N, row.stroke);
    return ++seen % 65536 != 0 || control.may_continue(fraction);
  });
  if (!status) return status.error();
  return rows;
}

// Best choice of one index out of each range, in ascending order where the
// ranges are the same: exhaustive.
struct Choice {
  std::vector<std::size_t> chosen;
  double residual = std::numeric_limits<double>::infinity();
};

void search(const Problem& problem, const TimeEquations& equations, std::size_t first, std::size_t left,
            std::vector<std::size_t>& prefix, Choice& best) {
  if (left == 0) {
    const double residual = problem.residual(equations, prefix);
    if (residual < best.residual) best = {prefix, residual};
    return;
  }
  for (std::size_t i = first; i + left <= problem.times_s().size(); ++i) {
    prefix.push_back(i);
    search(problem, equations, i + 1, left - 1, prefix, best);
    prefix.pop_back();
  }
}

Choice best_of(const Problem& problem, const TimeEquations& equations, std::size_t count) {
  Choice best;
  std::vector<std::size_t> prefix;
  search(problem, equations, 0, count, prefix, best);
  return best;
}

// One time per group of 2 kFineSteps + 1 neighbours of a fine ladder; group g
// begins at `first` + g groups.
struct FineChoice {
  std::vector<std::size_t> at;
  double residual = 0.0;
};

FineChoice best_fine(const Problem& fine, const TimeEquations& equations, std::size_t first, std::size_t count) {
  constexpr std::size_t kGroup = 2 * kFineSteps + 1;
  FineChoice best;
  for (std::size_t g = 0; g < count; ++g) best.at.push_back(first + g * kGroup + kFineSteps);
  best.residual = fine.residual(equations, best.at);
  // Coordinate descent: the problem is smooth and the start is near.
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t g = 0; g < count; ++g) {
      for (std::size_t i = 0; i < kGroup; ++i) {
        auto trial = best.at;
        trial[g] = first + g * kGroup + i;
        const double residual = fine.residual(equations, trial);
        if (residual < best.residual * (1.0 - 1e-12)) {
          best = {trial, residual};
          moved = true;
        }
      }
    }
  }
  return best;
}

// The times of a choice, each moved to the minimum of a parabola through its
// neighbours in log time.
std::vector<double> interpolated(const Problem& fine, const TimeEquations& equations, const FineChoice& best,
                                 std::size_t first) {
  constexpr std::size_t kGroup = 2 * kFineSteps + 1;
  std::vector<double> times_s;
  for (std::size_t g = 0; g < best.at.size(); ++g) {
    const std::size_t at = best.at[g];
    double time_s = fine.times_s()[at];
    if (at > first + g * kGroup && at + 1 < first + (g + 1) * kGroup) {
      auto trial = best.at;
      trial[g] = at - 1;
      const double below = fine.residual(equations, trial);
      trial[g] = at + 1;
      const double above = fine.residual(equations, trial);
      const double curvature = below - 2.0 * best.residual + above;
      const double offset = curvature > 0.0 ? std::clamp(0.5 * (below - above) / curvature, -0.5, 0.5) : 0.0;
      time_s *= std::pow(fine.times_s()[at + 1] / fine.times_s()[at], offset);
    }
    times_s.push_back(time_s);
  }
  return times_s;
}

std::vector<double> ladder(double shortest_s) {
  std::vector<double> times_s;
  for (std::size_t i = 0; i < kLadder; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(kLadder - 1);
    times_s.push_back(shortest_s * std::pow(kLongestTime_s / shortest_s, share));
  }
  return times_s;
}

// Around every centre 2 kFineSteps + 1 times, over one coarse step to each side.
std::vector<double> fine_ladders(const std::array<std::vector<double>, kMaximumTimes>& centres_s) {
  const double ratio = std::pow(kLongestTime_s / kShortestTime_s, 1.0 / static_cast<double>((kLadder - 1) * kFineSteps));
  std::vector<double> times_s;
  for (const std::vector<double>& centres : centres_s) {
    for (const double centre_s : centres) {
      for (int step = -kFineSteps; step <= kFineSteps; ++step) times_s.push_back(centre_s * std::pow(ratio, step));
    }
  }
  return times_s;
}

// Where the groups of a number of times begin in the fine ladder of all.
constexpr std::size_t first_of(std::size_t count) {
  return (2 * kFineSteps + 1) * (count * (count - 1) / 2);
}

}  // namespace

Result<RelaxationIdentification> identify_relaxation(MotionSource& source, double reference_depth_m,
                                                     double thinning_velocity_m_per_s, Weighting weighting, const JndLine& jnd,
                                                     double force_noise_floor_N, const FitControl& control) {
  // A time shorter than two samples cannot be told from viscosity.
  double duration_s = 0.0;
  std::size_t steps = 0;
  double last_s = 0.0;
  Status status = source.for_each([&](const MotionRow& row) {
    if (!row.first) {
      duration_s += row.sample.time_s - last_s;
      ++steps;
    }
    last_s = row.sample.time_s;
    return true;
  }, control, 0.05);
  if (!status) return status.error();
  const double shortest_s = std::clamp(2.0 * duration_s / static_cast<double>(std::max<std::size_t>(steps, 1)),
                                       kShortestTime_s, 0.1 * kLongestTime_s);

  auto rows = gather(source, reference_depth_m, thinning_velocity_m_per_s, ladder(shortest_s), control, 0.06);
  if (!rows) return rows.error();
  if (rows->count() < kMinimumRows) {
    return Error{"relaxation times need at least " + std::to_string(kMinimumRows) + " samples in contact, found " +
                 std::to_string(rows->count()) + "; record longer, or pass --relaxation scene"};
  }
  const Problem coarse(std::move(*rows), weighting, jnd, force_noise_floor_N);

  // Centres of the fine ladders, by number of times.
  std::array<std::vector<double>, kMaximumTimes> centres_s;
  for (std::size_t count = 1; count <= kMaximumTimes; ++count) {
    for (const std::size_t index : best_of(coarse, coarse.total(), count).chosen) {
      centres_s[count - 1].push_back(coarse.times_s()[index]);
    }
    if (!control.may_continue(0.06 + 0.02 * static_cast<double>(count))) return interrupted();
  }

  auto fine_rows = gather(source, reference_depth_m, thinning_velocity_m_per_s, fine_ladders(centres_s), control, 0.13);
  if (!fine_rows) return fine_rows.error();
  const Problem fine(std::move(*fine_rows), weighting, jnd, force_noise_floor_N);

  std::array<FineChoice, kMaximumTimes> choices;
  std::vector<double> between_s;  // of each number of times, behind each other
  for (std::size_t count = 1; count <= kMaximumTimes; ++count) {
    choices[count - 1] = best_fine(fine, fine.total(), first_of(count), count);
    const auto times_s = interpolated(fine, fine.total(), choices[count - 1], first_of(count));
    between_s.insert(between_s.end(), times_s.begin(), times_s.end());
  }

  // Scored at the times themselves: with little noise a true time between two of
  // the ladder would pass for both of them.
  auto fine_score_rows = gather(source, reference_depth_m, thinning_velocity_m_per_s, between_s, control, 0.14);
  if (!fine_score_rows) return fine_score_rows.error();
  const Problem scored(std::move(*fine_score_rows), weighting, jnd, force_noise_floor_N);
  RelaxationIdentification result;
  std::size_t next = 0;
  for (std::size_t count = 1; count <= kMaximumTimes; ++count) {
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(next++);
    double left_out = 0.0;
    for (std::size_t fold = 0; fold < kFolds; ++fold) left_out += scored.left_out(fold, chosen);
    result.error_over_jnd.push_back(std::sqrt(left_out / scored.total().count));
  }
  const double least = *std::min_element(result.error_over_jnd.begin(), result.error_over_jnd.end());
  std::size_t count = 1;
  while (result.error_over_jnd[count - 1] > kWorthwhile * least) ++count;

  const std::size_t first = first_of(count);
  const std::vector<double> times_s = interpolated(fine, fine.total(), choices[count - 1], first);
  std::vector<std::vector<double>> jackknife;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    const TimeEquations rest = fine.without(fold);
    jackknife.push_back(interpolated(fine, rest, best_fine(fine, rest, first, count), first));
  }
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    double mean = 0.0;
    for (const auto& estimate : jackknife) mean += estimate[i] / kFolds;
    double sum = 0.0;
    for (const auto& estimate : jackknife) sum += (estimate[i] - mean) * (estimate[i] - mean);
    result.times.push_back({times_s[i], std::sqrt(sum * (kFolds - 1) / kFolds)});
  }
  std::sort(result.times.begin(), result.times.end(),
            [](const IdentifiedTime& a, const IdentifiedTime& b) { return a.time_s < b.time_s; });
  return result;
}

}  // namespace palpate
