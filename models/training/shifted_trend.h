// The trend fitted to rows whose positions are moved, as a small least-squares
// problem: what the search for a surface minimises.
//
//   J(d0) = min_x sum_i s_i^2 (f_i - max(0, T(p_i - d0; x)))^2,  x >= 0
//
// over all rows, those in air (p_i <= d0, where the model says 0) included, so
// that J of different offsets can be compared. s_i = 1 / JND(f_i). Basis and
// one-sided contact are those of models/training/fit_trend.h.
// Thread guarantee: slow side, pure.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "models/training/surface_rows.h"
#include "models/training/trend_rows.h"

namespace palpate {

// Sums over rows: G = sum s^2 b b^T, h = sum s^2 b f, sum s^2 f^2, how many.
struct RowSums {
  Eigen::MatrixXd gram;
  Eigen::VectorXd right_side;
  double squares = 0.0;
  double count = 0.0;

  explicit RowSums(Eigen::Index columns = 0);
  RowSums& operator+=(const RowSums& other);
  RowSums& operator-=(const RowSums& other);
  // sum s^2 (f - b x)^2.
  double residual(const Eigen::VectorXd& x) const;
  // J: the least of it over x >= 0.
  double least() const;
};

// What the trend is made of, and which rows count.
struct TrendForm {
  double reference_depth_m = 1.0;
  double thinning_velocity_m_per_s = 0.0;  // 0: no viscous terms
  std::vector<double> relaxation_times_s;
  // Recorded positions, before any offset: rows deeper only move the filters,
  // rows farther out are left out.
  double deepest_m = 1.0;
  double farthest_m = -1.0;
  double no_force_N = 0.01;  // at or below it a sample counts as "no measured force"

  Eigen::Index columns() const;
};

inline constexpr std::size_t kSurfaceFolds = 8;

struct ShiftedTrend {
  Eigen::VectorXd x;
  double cost = 0.0;
  // Of rows in turn, whole strokes where they are short; empty unless asked for.
  std::vector<RowSums> folds;
};

// `rows` in time order, force zero taken off.
ShiftedTrend fit_shifted_trend(const std::vector<SurfaceRow>& rows, double offset_m, const TrendForm& form,
                               bool with_folds = false);

// The rows of the regression at `offset_m` with the depth changed by a further
// `step_m`, for derivatives: the same rows count for every step.
TrendRows shifted_rows(const std::vector<SurfaceRow>& rows, double offset_m, double step_m, const TrendForm& form,
                       double* air_squares = nullptr);

}  // namespace palpate
