// Non-negative least squares by the active-set method.
// Source: Lawson & Hanson (1974), Solving Least Squares Problems, chapter 23.
// Thread guarantee: pure function, slow side.
#pragma once

#include <Eigen/Core>

namespace palpate {

// Minimises x^T G x - 2 b^T x subject to x >= 0. `gram`: G, n x n, symmetric, positive semidefinite; a ridge of 1e-8
// separates equal columns. `start`: initial x, n values >= 0, or empty. Returns n values.
Eigen::VectorXd solve_non_negative(const Eigen::MatrixXd& gram, const Eigen::VectorXd& right_side,
                                   const Eigen::VectorXd& start = {});

}  // namespace palpate
