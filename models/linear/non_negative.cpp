#include "models/linear/non_negative.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate {
namespace {

// A ridge for columns of unit norm. It is far below the information in a recording and far above rounding, and only
// decides between equal columns.
constexpr double kEqualColumns = 1e-8;

// The active-set method of Lawson & Hanson, with columns of unit norm.
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
    // The method ends after a few changes; 3 n is the limit of its authors.
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

  // Moves x towards the minimum over the passive set. A coefficient that would become negative stops the step and
  // leaves the set.
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

}  // namespace

Eigen::VectorXd solve_non_negative(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right_side,
                                   const Eigen::VectorXd& start) {
  Eigen::VectorXd inverse_norm = gram.diagonal();
  for (double& value : inverse_norm) value = value > 0.0 ? 1.0 / std::sqrt(value) : 0.0;
  Eigen::MatrixXd scaled = inverse_norm.asDiagonal() * gram * inverse_norm.asDiagonal();
  scaled.diagonal().array() += kEqualColumns;
  NonNegativeSolver solver(std::move(scaled), right_side.cwiseProduct(inverse_norm));
  if (start.size() > 0 && (start.array() > 0.0).any()) {
    const auto moving = inverse_norm.array() > 0.0;
    solver.start_at(moving.select(start.array() / moving.select(inverse_norm.array(), 1.0), 0.0).matrix());
  }
  return solver.solve().cwiseMax(0.0).cwiseProduct(inverse_norm);
}

}  // namespace palpate
