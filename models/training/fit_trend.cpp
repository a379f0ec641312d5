#include "models/training/fit_trend.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "models/model/bernstein.h"

namespace palpate {
namespace {

// Relative to unit-norm columns: far below any information in a recording, far
// above rounding; decides only between columns that are equal.
constexpr double kRidge = 1e-8;
constexpr int kActiveSetPasses = 6;
// Faster than the recording by this factor the velocity stops counting.
constexpr double kVelocityMargin = 1.5;

struct NormalEquations {
  Eigen::MatrixXd gram;
  Eigen::VectorXd right_side;
};

NormalEquations normal_equations(const TrendRows& rows, const std::vector<double>& scale,
                                 const std::vector<char>& active) {
  const auto n = static_cast<Eigen::Index>(rows.columns());
  constexpr Eigen::Index kRowBlock = 512;
  NormalEquations sum{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  Eigen::MatrixXd block(n, kRowBlock);
  Eigen::VectorXd force(kRowBlock);
  Eigen::Index filled = 0;
  const auto flush = [&] {
    const auto used = block.leftCols(filled);
    sum.gram.selfadjointView<Eigen::Lower>().rankUpdate(used);
    sum.right_side.noalias() += used * force.head(filled);
    filled = 0;
  };
  for (std::size_t i = 0; i < rows.count(); ++i) {
    if (!active[i]) continue;
    block.col(filled) = scale[i] * Eigen::Map<const Eigen::VectorXd>(rows.row(i), n);
    force(filled) = scale[i] * rows.force_N(i);
    if (++filled == kRowBlock) flush();
  }
  flush();
  sum.gram.triangularView<Eigen::StrictlyUpper>() = sum.gram.transpose();
  return sum;
}

double dot(const double* row, const Eigen::VectorXd& coefficients) {
  return Eigen::Map<const Eigen::VectorXd>(row, coefficients.size()).dot(coefficients);
}

// Lawson & Hanson's working state on unit-norm columns.
class NonNegativeSolver {
 public:
  NonNegativeSolver(Eigen::MatrixXd gram, Eigen::VectorXd right_side)
      : gram_(std::move(gram)),
        right_side_(std::move(right_side)),
        x_(Eigen::VectorXd::Zero(right_side_.size())),
        passive_(static_cast<std::size_t>(right_side_.size()), 0) {}

  void start_at(const Eigen::VectorXd& x) {
    x_ = x;
    for (Eigen::Index i = 0; i < x_.size(); ++i) passive_[static_cast<std::size_t>(i)] = x_(i) > 0.0 ? 1 : 0;
    move_to_minimum();
  }

  Eigen::VectorXd solve() {
    // They end after few changes; 3 n is their own bound.
    for (Eigen::Index change = 0; change < 3 * x_.size(); ++change) {
      const Eigen::Index entering = most_promising();
      if (entering < 0) break;
      passive_[static_cast<std::size_t>(entering)] = 1;
      move_to_minimum();
    }
    return x_;
  }

 private:
  bool passive(Eigen::Index i) const { return passive_[static_cast<std::size_t>(i)] != 0; }

  Eigen::Index most_promising() const {
    const Eigen::VectorXd gradient = right_side_ - gram_ * x_;
    const double tolerance = 1e-12 * std::max(1e-300, right_side_.cwiseAbs().maxCoeff());
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (passive(i) || gradient(i) <= tolerance) continue;
      if (best < 0 || gradient(i) > gradient(best)) best = i;
    }
    return best;
  }

  Eigen::VectorXd unconstrained() const {
    std::vector<Eigen::Index> index;
    for (Eigen::Index i = 0; i < x_.size(); ++i) {
      if (passive(i)) index.push_back(i);
    }
    Eigen::VectorXd full = Eigen::VectorXd::Zero(x_.size());
    if (index.empty()) return full;
    const Eigen::MatrixXd part = gram_(index, index);
    const Eigen::VectorXd part_right_side = right_side_(index);
    const Eigen::VectorXd solution = part.llt().solve(part_right_side);
    full(index) = solution;
    return full;
  }

  // Walks towards the minimum over the passive set; a coefficient that would
  // turn negative stops the walk and leaves the set.
  void move_to_minimum() {
    Eigen::VectorXd candidate = unconstrained();
    for (Eigen::Index leaving = 0; leaving < x_.size(); ++leaving) {
      double step = 1.0;
      Eigen::Index blocking = -1;
      for (Eigen::Index i = 0; i < x_.size(); ++i) {
        if (!passive(i) || candidate(i) > 0.0) continue;
        const double reach = x_(i) / std::max(x_(i) - candidate(i), 1e-300);
        if (blocking < 0 || reach < step) {
          step = std::min(1.0, reach);
          blocking = i;
        }
      }
      if (blocking < 0) break;
      x_ += step * (candidate - x_);
      x_(blocking) = 0.0;
      passive_[static_cast<std::size_t>(blocking)] = 0;
      candidate = unconstrained();
    }
    x_ = candidate;
  }

  Eigen::MatrixXd gram_;
  Eigen::VectorXd right_side_;
  Eigen::VectorXd x_;
  std::vector<char> passive_;
};

Trend trend_from(const TrendRows& rows, const Eigen::VectorXd& x) {
  Trend trend;
  trend.reference_depth_m = rows.reference_depth_m();
  Eigen::Index column = 0;
  if (rows.terms().spline_elastic) {
    const DriveCurve spline = combined_spline(x.data(), rows.reference_depth_m());
    std::copy(spline.coefficient_N.begin(), spline.coefficient_N.end(), trend.elastic_N.begin());
    trend.has_elastic_knots = true;
    trend.elastic_knot_N = spline.knot_N;
    column = kSplineTerms;
  } else {
    for (std::size_t k = 0; k < kElasticCoefficients; ++k, ++column) {
      const auto power = bernstein_integral<kElasticCoefficients - 1>(k);
      for (std::size_t j = 0; j < power.size(); ++j) trend.elastic_N[j] += x(column) * power[j];
    }
  }
  if (rows.viscous_columns() > 0) {
    trend.thinning_velocity_m_per_s = rows.thinning_velocity_m_per_s();
    for (auto* viscosity : {&trend.viscosity_Ns_per_m, &trend.thinning_Ns_per_m}) {
      for (std::size_t k = 0; k < kViscosityCoefficients; ++k, ++column) {
        const auto power = bernstein<kViscosityCoefficients - 1>(k);
        for (std::size_t j = 0; j < power.size(); ++j) (*viscosity)[j] += x(column) * power[j];
      }
    }
  }
  for (std::size_t i = 0; i < rows.terms().peak_times_s.size(); ++i) {
    for (std::size_t j = 0; j < kSofteningPowers.size(); ++j) {
      const double* weights = x.data() + rows.first_softening() + i * kSofteningTerms + j * kBranchTerms;
      trend.softening[j] = combined_drive(weights, rows.reference_depth_m());
    }
  }
  for (std::size_t i = 0; i < rows.count(); ++i) {
    trend.velocity_limit_m_per_s =
        std::max(trend.velocity_limit_m_per_s, kVelocityMargin * std::abs(rows.velocity_m_per_s(i)));
  }
  return trend;
}

// Columns: the directions in which the coefficients may move. Driven by velocity,
// those of a branch move together: their sum is g(d) = d.
Eigen::MatrixXd free_directions(const TrendRows& rows, BranchDrive drive) {
  const auto n = static_cast<Eigen::Index>(rows.columns());
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(n, n);
  if (drive == BranchDrive::elastic_rate) return all;
  constexpr auto kTerms = static_cast<Eigen::Index>(kBranchTerms);
  const auto branches = static_cast<Eigen::Index>(rows.relaxation_times_s().size());
  const Eigen::Index first = n - kTerms * branches;
  Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(n, first + branches);
  directions.leftCols(first) = all.leftCols(first);
  for (Eigen::Index b = 0; b < branches; ++b) directions.col(first + b).segment(first + b * kTerms, kTerms).setOnes();
  return directions;
}

}  // namespace

Eigen::VectorXd solve_non_negative(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right_side,
                                   const Eigen::VectorXd& start) {
  Eigen::VectorXd inverse_norm = gram.diagonal();
  for (double& value : inverse_norm) value = value > 0.0 ? 1.0 / std::sqrt(value) : 0.0;
  Eigen::MatrixXd scaled = inverse_norm.asDiagonal() * gram * inverse_norm.asDiagonal();
  scaled.diagonal().array() += kRidge;
  NonNegativeSolver solver(std::move(scaled), right_side.cwiseProduct(inverse_norm));
  if (start.size() > 0 && (start.array() > 0.0).any()) {
    const auto moving = inverse_norm.array() > 0.0;
    solver.start_at(moving.select(start.array() / moving.select(inverse_norm.array(), 1.0), 0.0).matrix());
  }
  return solver.solve().cwiseMax(0.0).cwiseProduct(inverse_norm);
}

FittedTrend fit_trend(const TrendRows& rows, Weighting weighting, const JndLine& jnd, double force_noise_floor_N,
                      BranchDrive drive, bool robust) {
  FittedTrend fitted;
  const Eigen::MatrixXd directions = free_directions(rows, drive);
  std::vector<double> scale(rows.count());
  fitted.active.assign(rows.count(), 1);
  for (std::size_t i = 0; i < rows.count(); ++i) scale[i] = row_scale(weighting, jnd, rows.force_N(i));
  Eigen::VectorXd x;
  for (int pass = 0; pass < kActiveSetPasses; ++pass) {
    NormalEquations equations = normal_equations(rows, scale, fitted.active);
    rows.smooth_splines(equations.gram);
    x = directions * solve_non_negative(directions.transpose() * equations.gram * directions,
                                        directions.transpose() * equations.right_side);
    bool changed = false;
    for (std::size_t i = 0; i < rows.count(); ++i) {
      if (robust) {
        const double plain = row_scale(weighting, jnd, rows.force_N(i));
        const double scaled = plain * robust_scale(jnd.error_over_jnd(dot(rows.row(i), x), rows.force_N(i)));
        changed = changed || std::abs(scaled - scale[i]) > 0.1 * plain;
        scale[i] = scaled;
      }
      if (rows.force_N(i) > force_noise_floor_N) continue;
      const char counts = dot(rows.row(i), x) > 0.0 ? 1 : 0;
      changed = changed || counts != fitted.active[i];
      fitted.active[i] = counts;
    }
    if (!changed) break;
  }
  fitted.trend = trend_from(rows, x);
  const std::size_t first = rows.first_branch();
  for (std::size_t b = 0; b < rows.relaxation_times_s().size(); ++b) {
    const double* weights = x.data() + first + b * rows.branch_terms();
    FeatureSpec branch{FeatureKind::maxwell_branch, rows.relaxation_times_s()[b],
                       rows.terms().spline_branches ? combined_spline(weights, rows.reference_depth_m())
                                                    : combined_drive(weights, rows.reference_depth_m())};
    branch.slowing = rows.terms().slowing;
    fitted.branches.push_back(branch);
  }
  for (std::size_t s = 0; s < rows.terms().stop_thresholds_m.size(); ++s) {
    const double* weights = x.data() + rows.first_stop() + s * kStopTerms;
    if (std::all_of(weights, weights + kStopTerms, [](double weight) { return weight == 0.0; })) continue;
    fitted.stops.push_back(
        {0.0, rows.terms().stop_thresholds_m[s], combined_friction(weights, rows.reference_depth_m())});
  }
  double sum = 0.0;
  std::size_t counted = 0;
  for (std::size_t i = 0; i < rows.count(); ++i) {
    if (!fitted.active[i]) continue;
    const double error = scale[i] * (rows.force_N(i) - dot(rows.row(i), x));
    sum += error * error;
    ++counted;
  }
  fitted.weighted_rms = counted > 0 ? std::sqrt(sum / static_cast<double>(counted)) : 0.0;
  return fitted;
}

}  // namespace palpate
