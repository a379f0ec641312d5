#include "models/training/surface_registration.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/tick/jnd.h"
#include "models/training/fit_trend.h"
#include "models/training/surface_estimate.h"
#include "models/training/surface_rows.h"
#include "models/training/trend_rows.h"
#include "models/training/surface_numbers.h"

namespace palpate {
namespace {

// Rows of all recordings together for the common trend, and of each for its onset.
constexpr std::size_t kCommonRows = 4000;
constexpr std::size_t kOnsetRows = 400000;
// A shift common to all recordings changes no force of the model, only where its zero
// lies; below what the onset of real specimens tells it stays as recorded.
constexpr double kLeastCommonShift_m = 0.25e-3;
constexpr std::size_t kRegistrationFolds = 8;
constexpr std::size_t kPiecesOfARecording = 16;
constexpr int kSteps = 12;
constexpr int kActivePasses = 3;
constexpr double kConverged_m = 0.2e-6;
constexpr double kLongestStep_m = 0.5e-3;
constexpr double kDerivativeStep_m = 10e-6;
// Errors beyond this many JND count in proportion only (Huber): another specimen
// or a slip must not decide where the surface is.
constexpr double kHuber = 2.0;
// The share of what the trend cannot follow that may look like a shift: on pairs of
// virtual recordings, most of materials that are no sum of springs and dashpots, two of
// these shares were never exceeded (worst: a sponge with 0.43 of its misfit).
constexpr double kMisfitShare = 0.35;
constexpr double kNoForceDeviations = 3.0;
constexpr double kNoForceFloor_N = 0.01;

struct Member {
  std::vector<SurfaceRow> rows;  // thinned, force zero taken off
  SurfaceEstimate own;
};

Member member_of(const std::vector<SurfaceRow>& rows, double force_noise_N, std::size_t common_rows) {
  Member member;
  member.own = estimate_surface(rows, force_noise_N);
  member.rows = thinned_rows(rows, common_rows);
  for (SurfaceRow& row : member.rows) row.force_N -= member.own.force_zero_N;
  return member;
}

// Sums of the normal equations in trend coefficients and offsets together.
struct Sums {
  Eigen::MatrixXd gram;
  Eigen::VectorXd right_side;

  explicit Sums(Eigen::Index n) : gram(Eigen::MatrixXd::Zero(n, n)), right_side(Eigen::VectorXd::Zero(n)) {}
};

// All recordings with one trend; the offsets are the unknowns.
class CommonTrend {
 public:
  CommonTrend(const std::vector<Member>& members, const std::vector<FeatureSpec>& features, double no_force_N,
              const std::vector<double>& start_m)
      : members_(members), no_force_N_(no_force_N) {
    bool viscous = false;
    for (const FeatureSpec& spec : features) {
      viscous = viscous || spec.kind == FeatureKind::velocity;
      if (spec.kind == FeatureKind::lowpass_velocity) times_s_.push_back(spec.relaxation_time_s);
    }
    double squares = 0.0;
    double count = 0.0;
    for (std::size_t r = 0; r < members.size(); ++r) {
      for (const SurfaceRow& row : members[r].rows) {
        const double depth_m = row.motion.position_m - start_m[r];
        if (!(depth_m > 0.0)) continue;
        depth_m_ = std::max(depth_m_, depth_m);
        squares += row.motion.velocity_m_per_s * row.motion.velocity_m_per_s;
        count += 1.0;
      }
    }
    velocity_m_per_s_ = viscous ? std::max(1e-6, std::sqrt(squares / std::max(count, 1.0))) : 0.0;
  }

  // The best trend with the recordings moved by `offsets_m`; returns J.
  double fit(const std::vector<double>& offsets_m) {
    at_.clear();
    stepped_.clear();
    air_cost_ = 0.0;
    for (std::size_t r = 0; r < members_.size(); ++r) {
      at_.push_back(rows_of(r, offsets_m[r], 0.0, &air_cost_));
      stepped_.push_back(rows_of(r, offsets_m[r], kDerivativeStep_m, nullptr));
    }
    begin_weights();
    for (int pass = 0; pass < kActivePasses; ++pass) {
      const Sums sums = trend_sums();
      x_ = solve_non_negative(sums.gram, sums.right_side);
      if (!update_weights()) break;
    }
    return cost();
  }

  // The Gauss-Newton step of every offset, their sum kept; `without` leaves out
  // one fold. Needs a fit.
  std::vector<double> step(std::size_t without = kRegistrationFolds) const {
    const auto n = static_cast<Eigen::Index>(at_.front().columns());
    const auto m = static_cast<Eigen::Index>(members_.size());
    Sums sums(n + m);
    for (std::size_t fold = 0; fold < kRegistrationFolds; ++fold) {
      if (fold == without) continue;
      sums.gram += folds_[fold].gram;
      sums.right_side += folds_[fold].right_side;
    }
    // A stiff spring on the sum keeps it at zero.
    Eigen::MatrixXd offsets = sums.gram.bottomRightCorner(m, m);
    const double stiff = std::max(1e-12, offsets.diagonal().maxCoeff());
    offsets.diagonal().array() += 1e-9 * stiff;
    offsets.array() += 1e3 * stiff;
    const Eigen::LLT<Eigen::MatrixXd> solver(offsets);
    const Eigen::MatrixXd coupling = sums.gram.topRightCorner(n, m);
    const Eigen::VectorXd force = sums.right_side.tail(m);
    const Eigen::MatrixXd gram = sums.gram.topLeftCorner(n, n) - coupling * solver.solve(coupling.transpose());
    const Eigen::VectorXd right_side = sums.right_side.head(n) - coupling * solver.solve(force);
    const Eigen::VectorXd x = solve_non_negative(gram, right_side);
    const Eigen::VectorXd step = solver.solve(force - coupling.transpose() * x);
    return {step.data(), step.data() + m};
  }

  // By how much recording `r` would have to move to change its forces by their RMS
  // error. Needs `gather`.
  double misfit_m(std::size_t r) const {
    const auto at = static_cast<Eigen::Index>(at_.front().columns() + r);
    double slopes = 0.0;
    for (const Sums& fold : folds_) slopes += fold.gram(at, at);
    double squares = 0.0;
    for (std::size_t i = 0; i < at_[r].count(); ++i) {
      const double error = scale_[r][i] * (at_[r].force_N(i) - predicted_N(at_[r], i));
      squares += error * error;
    }
    return slopes > 0.0 ? std::sqrt(squares / slopes) : kUnknownError;
  }

  // Sums by fold, for `step`.
  void gather() {
    const auto n = static_cast<Eigen::Index>(at_.front().columns());
    const auto m = static_cast<Eigen::Index>(members_.size());
    folds_.assign(kRegistrationFolds, Sums(n + m));
    Eigen::VectorXd column(n + 1);
    for (std::size_t r = 0; r < at_.size(); ++r) {
      const TrendRows& rows = at_[r];
      const auto offset = n + static_cast<Eigen::Index>(r);
      const std::size_t piece = rows.count() / kPiecesOfARecording + 1;
      for (std::size_t i = 0; i < rows.count(); ++i) {
        const double scale = scale_[r][i];
        if (scale == 0.0) continue;
        Sums& fold = folds_[(i / piece) % kRegistrationFolds];
        const double slope = (predicted_N(stepped_[r], i) - predicted_N(rows, i)) / kDerivativeStep_m;
        column.head(n) = scale * Eigen::Map<const Eigen::VectorXd>(rows.row(i), n);
        column(n) = scale * slope;
        const double force = scale * rows.force_N(i);
        fold.gram.topLeftCorner(n, n).noalias() += column.head(n) * column.head(n).transpose();
        fold.gram.col(offset).head(n) += column(n) * column.head(n);
        fold.gram(offset, offset) += column(n) * column(n);
        fold.right_side.head(n) += force * column.head(n);
        fold.right_side(offset) += force * column(n);
      }
    }
    for (Sums& fold : folds_) fold.gram.bottomLeftCorner(m, n) = fold.gram.topRightCorner(n, m).transpose();
  }

 private:
  TrendRows rows_of(std::size_t r, double offset_m, double step_m, double* air_cost) const {
    TrendRows rows(depth_m_, velocity_m_per_s_, times_s_);
    rows.begin_recording();
    for (const SurfaceRow& row : members_[r].rows) {
      ToolSample sample = row.sample;
      MotionEstimate motion = row.motion;
      sample.position_m -= offset_m;
      motion.position_m -= offset_m + step_m;
      rows.add(sample, motion, row.force_N, 0);
      if (air_cost != nullptr && !(sample.position_m > 0.0)) *air_cost += huber(row.force_N / jnd_.at(row.force_N));
    }
    return rows;
  }

  static double huber(double ratio) {
    const double size = std::abs(ratio);
    return size <= kHuber ? size * size : kHuber * (2.0 * size - kHuber);
  }

  double predicted_N(const TrendRows& rows, std::size_t i) const {
    return Eigen::Map<const Eigen::VectorXd>(rows.row(i), x_.size()).dot(x_);
  }

  void begin_weights() {
    scale_.clear();
    for (const TrendRows& rows : at_) {
      scale_.emplace_back(rows.count());
      for (std::size_t i = 0; i < rows.count(); ++i) scale_.back()[i] = 1.0 / jnd_.at(rows.force_N(i));
    }
  }

  // Contact is one-sided, large errors count less. Returns whether a row changed sides.
  bool update_weights() {
    bool changed = false;
    for (std::size_t r = 0; r < at_.size(); ++r) {
      for (std::size_t i = 0; i < at_[r].count(); ++i) {
        const double force_N = at_[r].force_N(i);
        const double model_N = predicted_N(at_[r], i);
        const bool idle = force_N <= no_force_N_ && !(model_N > 0.0);
        const double ratio = std::abs(force_N - model_N) / jnd_.at(force_N);
        const double scale = idle ? 0.0 : std::sqrt(std::min(1.0, kHuber / std::max(ratio, 1e-12))) / jnd_.at(force_N);
        changed = changed || (scale == 0.0) != (scale_[r][i] == 0.0) || ratio > kHuber;
        scale_[r][i] = scale;
      }
    }
    return changed;
  }

  Sums trend_sums() const {
    const auto n = static_cast<Eigen::Index>(at_.front().columns());
    Sums sums(n);
    for (std::size_t r = 0; r < at_.size(); ++r) {
      for (std::size_t i = 0; i < at_[r].count(); ++i) {
        const double scale = scale_[r][i];
        if (scale == 0.0) continue;
        const Eigen::Map<const Eigen::VectorXd> row(at_[r].row(i), n);
        sums.gram.selfadjointView<Eigen::Lower>().rankUpdate(row, scale * scale);
        sums.right_side += scale * scale * at_[r].force_N(i) * row;
      }
    }
    sums.gram.triangularView<Eigen::StrictlyUpper>() = sums.gram.transpose();
    return sums;
  }

  double cost() const {
    double sum = air_cost_;
    for (const TrendRows& rows : at_) {
      for (std::size_t i = 0; i < rows.count(); ++i) {
        sum += huber((rows.force_N(i) - std::max(0.0, predicted_N(rows, i))) / jnd_.at(rows.force_N(i)));
      }
    }
    return sum;
  }

  const std::vector<Member>& members_;
  double no_force_N_;
  JndLine jnd_;
  std::vector<double> times_s_;
  double depth_m_ = 1e-6;
  double velocity_m_per_s_ = 0.0;
  std::vector<TrendRows> at_;
  std::vector<TrendRows> stepped_;
  std::vector<std::vector<double>> scale_;
  std::vector<Sums> folds_;
  Eigen::VectorXd x_;
  double air_cost_ = 0.0;
};

struct Consistent {
  std::vector<double> offset_m;
  std::vector<double> error_m;

  // What cannot be told from 0.
  double least_m(std::size_t r) const { return std::max(kLeastOffset_m, kSignificantErrors * error_m[r]); }
};

Consistent align(CommonTrend& trend, std::vector<double> offset_m) {
  double cost = trend.fit(offset_m);
  for (int round = 0; round < kSteps; ++round) {
    trend.gather();
    const std::vector<double> step = trend.step();
    double longest_m = 0.0;
    for (const double value : step) longest_m = std::max(longest_m, std::abs(value));
    double share = std::min(1.0, kLongestStep_m / std::max(longest_m, 1e-12));
    bool better = false;
    for (int halving = 0; halving < 4 && !better && share * longest_m > kConverged_m; ++halving, share *= 0.5) {
      std::vector<double> trial = offset_m;
      for (std::size_t r = 0; r < trial.size(); ++r) trial[r] += share * step[r];
      const double trial_cost = trend.fit(trial);
      better = trial_cost < cost;
      if (!better) continue;
      cost = trial_cost;
      offset_m = trial;
    }
    if (!better) break;
  }
  trend.fit(offset_m);
  trend.gather();
  Consistent result{offset_m, std::vector<double>(offset_m.size(), 0.0)};
  std::vector<std::vector<double>> left_out;
  for (std::size_t fold = 0; fold < kRegistrationFolds; ++fold) left_out.push_back(trend.step(fold));
  for (std::size_t r = 0; r < offset_m.size(); ++r) {
    double mean = 0.0;
    double sum = 0.0;
    for (const auto& step : left_out) mean += step[r] / kRegistrationFolds;
    for (const auto& step : left_out) sum += (step[r] - mean) * (step[r] - mean);
    const double jackknife_m = std::sqrt(sum * (kRegistrationFolds - 1.0) / kRegistrationFolds);
    result.error_m[r] = std::hypot(jackknife_m, kMisfitShare * trend.misfit_m(r));
  }
  return result;
}

// Recordings that this shift leaves as recorded.
std::size_t unmoved(const Consistent& consistent, double shift_m) {
  std::size_t count = 0;
  for (std::size_t r = 0; r < consistent.offset_m.size(); ++r) {
    if (std::abs(consistent.offset_m[r] + shift_m) <= consistent.least_m(r)) ++count;
  }
  return count;
}

// Of the shifts within `tolerance_m` of what the onsets say, the one that leaves most
// recordings as they are, and of those the nearest.
double simplest_shift_m(const Consistent& consistent, double onset_m, double tolerance_m) {
  double best_m = onset_m;
  std::size_t most = unmoved(consistent, onset_m);
  for (const double offset_m : consistent.offset_m) {
    if (std::abs(-offset_m - onset_m) > tolerance_m) continue;
    const std::size_t count = unmoved(consistent, -offset_m);
    const bool nearer = count == most && std::abs(-offset_m - onset_m) < std::abs(best_m - onset_m);
    if (count > most || nearer) {
      most = count;
      best_m = -offset_m;
    }
  }
  return best_m;
}

// Adds the shift common to all, from the onsets, weighted by their errors; without
// any the one that moves half of the recordings one way and half the other. Returns
// its error.
double anchor(Consistent& consistent, const std::vector<Member>& members) {
  double sum = 0.0;
  double weights = 0.0;
  for (std::size_t r = 0; r < members.size(); ++r) {
    const double own_error_m = members[r].own.standard_error_m;
    if (!std::isfinite(own_error_m)) continue;
    const double weight = 1.0 / (own_error_m * own_error_m);
    sum += weight * (members[r].own.raw_offset_m - consistent.offset_m[r]);
    weights += weight;
  }
  const double onset_m = weights > 0.0 ? sum / weights : -median_of(consistent.offset_m);
  const double error_m = weights > 0.0 ? std::sqrt(1.0 / weights) : kUnknownError;
  const double shift_m =
      simplest_shift_m(consistent, onset_m, std::max(kSignificantErrors * error_m, kLeastCommonShift_m));
  for (double& offset_m : consistent.offset_m) offset_m += shift_m;
  return error_m;
}

std::vector<RegisteredSurface> registered(const std::vector<Member>& members, const std::vector<FeatureSpec>& features,
                                          double no_force_N) {
  std::vector<RegisteredSurface> surfaces;
  for (const Member& member : members) {
    const bool told = members.size() > 1 || std::abs(member.own.offset_m) > kLeastCommonShift_m;
    surfaces.push_back({told ? member.own.offset_m : 0.0, member.own.standard_error_m, member.own.force_zero_N});
  }
  if (members.size() < 2) return surfaces;
  std::vector<double> start_m;
  for (const Member& member : members) {
    start_m.push_back(std::isfinite(member.own.standard_error_m) ? member.own.raw_offset_m : 0.0);
  }
  CommonTrend trend(members, features, no_force_N, start_m);
  Consistent consistent = align(trend, start_m);
  const double common_error_m = anchor(consistent, members);
  // One that is certainly elsewhere calls for all: half of a set moved is worse than none.
  const bool any = unmoved(consistent, 0.0) < members.size();
  for (std::size_t r = 0; r < members.size(); ++r) {
    const double offset_m = consistent.offset_m[r];
    surfaces[r].offset_m = any && std::abs(offset_m) > kLeastOffset_m ? offset_m : 0.0;
    surfaces[r].standard_error_m = std::hypot(consistent.error_m[r], common_error_m);
  }
  return surfaces;
}

}  // namespace

Result<std::vector<RegisteredSurface>> register_surfaces(MotionSource& source, const std::vector<FeatureSpec>& features,
                                                         const FitControl& control, double fraction) {
  std::vector<Member> members;
  GrowingStride rows(kOnsetRows);
  std::vector<std::vector<SurfaceRow>> recordings;
  const Status status = source.for_each([&](const MotionRow& row) {
    if (row.first && row.recording > 0) {
      recordings.push_back(rows.rows());
      rows = GrowingStride(kOnsetRows);
    }
    rows.add({row.sample, row.motion, row.force_N});
    return true;
  }, control, fraction);
  if (!status) return status.error();
  recordings.push_back(rows.rows());
  const std::size_t share = std::max<std::size_t>(200, kCommonRows / recordings.size());
  for (const auto& recording : recordings) members.push_back(member_of(recording, source.force_noise_N(), share));
  if (!control.go_on(fraction)) return interrupted();
  return registered(members, features, std::max(kNoForceFloor_N, kNoForceDeviations * source.force_noise_N()));
}

std::vector<RowCorrection> corrections_of(const std::vector<RegisteredSurface>& surfaces) {
  std::vector<RowCorrection> corrections;
  for (const RegisteredSurface& surface : surfaces) corrections.push_back({surface.offset_m, surface.force_zero_N});
  return corrections;
}

}  // namespace palpate
