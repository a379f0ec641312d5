// A regression of one force law over several recordings, whose residual measures how well their offsets agree:
//
//   F ~ c + E(z) + sum_t b_t + eta(z) v,   z = p(t - lag) - offset,   p: position, v: velocity, c: force zero
//
// E and the spring of each Maxwell branch b_t are rising splines over the positions, and eta is not negative. All are
// 0 in air, so the position of the surface is not needed. Residuals are divided by the noise plus 3 % of the force,
// with a Huber loss beyond 3. A row without force counts only where the fit is positive.
// Thread guarantee: one thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "models/recordings/profile_search.h"
#include "models/recordings/surface_rows.h"

namespace palpate {

class CommonFit {
 public:
  static constexpr std::size_t kBlocks = 10;  // of every recording, of equal path length of the tool

  // The splines reach from `low_m` to `high_m`. `noise_N`: standard deviation of the forces.
  CommonFit(double low_m, double high_m, double noise_N) : low_m_(low_m), high_m_(high_m), noise_N_(noise_N) {}

  // Adds a recording with its offset and lag to the recordings of the fit, its members.
  void add(const std::vector<SurfaceRow>& rows, double offset_m, double lag_s = 0.0);

  // The cost J of a fit of the members and one more recording, by blocks: first the kBlocks of that recording, then,
  // if there are members, kBlocks of all members together.
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
  // Adds the normal equations of one recording. `x`: weights whose residuals give the Huber weights, or empty.
  void add_equations(const Member& member, const Eigen::VectorXd& x, Eigen::MatrixXd& gram,
                     Eigen::VectorXd& right_side) const;

  double low_m_;
  double high_m_;
  double noise_N_;
  std::vector<Member> members_;
  Eigen::MatrixXd gram_;  // of the members, with the weights of their own fit
  Eigen::VectorXd right_side_;
};

}  // namespace palpate
