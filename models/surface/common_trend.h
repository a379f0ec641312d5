// The viscoelastic trend common to several recordings, and how far each would have to
// be moved along the normal to fit it best.
//
//   J(x, o) = sum over recordings r and rows i of H((F - x . b(d_i - o_r)) / JND(F))
//
// x: the trend's coefficients, not negative (models/training/fit_trend.h); o_r: the
// offset of recording r, m; H: squares up to two JND, in proportion beyond (Huber), so
// that another specimen or a slip does not decide where the surface is. Rows without
// force count only where the trend has one: contact is one-sided.
// Thread guarantee: one thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/surface/surface_estimate.h"
#include "models/surface/surface_rows.h"
#include "models/training/trend_rows.h"

namespace palpate {

struct RegisteredMember {
  std::vector<SurfaceRow> rows;  // thinned, force zero taken off
  SurfaceEstimate own;
};

class CommonTrend {
 public:
  // Folds of the rows that `step` can leave out.
  static constexpr std::size_t kFolds = 8;

  // `members` outlives this. `features`: those of the scene; low-pass velocities and
  // whether there is a velocity say which terms the trend has. `start_m`: a first
  // offset of each recording, for the range of depth and velocity.
  CommonTrend(const std::vector<RegisteredMember>& members, const std::vector<FeatureSpec>& features,
              double force_noise_floor_N, const std::vector<double>& start_m);

  // The best trend with the recordings moved by `offsets_m`; returns J.
  double fit(const std::vector<double>& offsets_m);

  // Sums by fold at the last fit, for `step` and `misfit_m`.
  void gather();

  // The Gauss-Newton step of every offset, m, their sum kept; `without` leaves out one
  // fold. Needs `gather`.
  std::vector<double> step(std::size_t without = kFolds) const;

  // By how much recording `r` would have to move to change its forces by their RMS
  // error; kUnknownError where its force does not depend on it. Needs `gather`.
  double misfit_m(std::size_t r) const;

 private:
  // Sums of the normal equations in trend coefficients and offsets together.
  struct Sums {
    Eigen::MatrixXd gram;
    Eigen::VectorXd right_side;

    explicit Sums(Eigen::Index n) : gram(Eigen::MatrixXd::Zero(n, n)), right_side(Eigen::VectorXd::Zero(n)) {}
  };

  TrendRows rows_of(std::size_t r, double offset_m, double step_m, double* air_cost) const;
  double predicted_N(const TrendRows& rows, std::size_t i) const;
  void begin_weights();
  bool update_weights();
  Sums trend_sums() const;
  double cost() const;

  const std::vector<RegisteredMember>& members_;
  double force_noise_floor_N_;
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

}  // namespace palpate
