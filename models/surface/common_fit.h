// One regression over recordings that lie somewhere to each other: rows in, what a common
// material leaves unexplained out.
//
//   F ~ c + E(z) + sum_t b_t + eta(z) v,   z = p(t - lag) - offset
//
// E, and the spring behind each Maxwell branch b_t, are rising splines over the positions
// themselves, eta is not negative, and none of them needs to know where the surface is:
// in air they are 0. A residual counts in units of noise and 3 % of the force, Huber's
// beyond 3; a row without force counts only where the fit has one.
// Thread guarantee: one thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "models/surface/profile_search.h"
#include "models/surface/surface_rows.h"

namespace palpate {

class CommonFit {
 public:
  static constexpr std::size_t kBlocks = 10;  // of every recording, by the way the tool went

  // Splines from `low_m` to `high_m`; `noise_N`: of the forces.
  CommonFit(double low_m, double high_m, double noise_N) : low_m_(low_m), high_m_(high_m), noise_N_(noise_N) {}

  // A recording with its place. Those added stay; `residual` tries one more beside them.
  void add(const std::vector<SurfaceRow>& rows, double offset_m, double lag_s = 0.0);

  // J by blocks: those of the recording tried, then, together, of those added.
  BlockCosts residual(const std::vector<SurfaceRow>& rows, double offset_m, double lag_s = 0.0) const;

 private:
  using Design = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  struct Member {
    Design design;
    Eigen::VectorXd force_N;
    Eigen::VectorXd scale;  // 1 / N
    std::vector<std::size_t> block;
  };

  Member member(const std::vector<SurfaceRow>& rows, double offset_m, double lag_s) const;
  void put_row(double z_m, double velocity_m_per_s, double* row) const;
  bool is_idle(double force_N, double predicted_N) const;
  double error(const Member& member, Eigen::Index i, double predicted_N) const;
  // Adds the normal equations of one recording, weighted for what `x` leaves (empty: not).
  void add_equations(const Member& member, const Eigen::VectorXd& x, Eigen::MatrixXd& gram,
                     Eigen::VectorXd& right_side) const;

  double low_m_;
  double high_m_;
  double noise_N_;
  std::vector<Member> members_;
  Eigen::MatrixXd gram_;  // of the members, as they last fitted by themselves
  Eigen::VectorXd right_side_;
};

}  // namespace palpate
