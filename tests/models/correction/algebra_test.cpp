#include "models/correction/algebra.h"

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "models/model/kernels.h"
#include "tests/support/message_parts.h"
#include "tests/support/plain_rbf.h"
#include "tests/support/random_points.h"

namespace palpate {
namespace {

using test::random_points;
using test::smooth_sites;

Eigen::MatrixXd naive_matrix(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres) {
  Eigen::MatrixXd matrix(sites.count(), centres.cols());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j)
      matrix(i, j) = kernel_value(kernel, (sites.points.col(i) - centres.col(j)).norm());
  Eigen::MatrixXd whole(sites.count(), matrix.cols() + tail_size(tail_degree(kernel), sites.dimension()));
  whole << matrix, tail_matrix(tail_degree(kernel), sites.points);
  return whole.array().colwise() * sites.row_scale.array();
}

RbfFunction solved(const Sites& sites, const Eigen::MatrixXd& centres) {
  return solve_weights(sites, centres).function();
}

TEST(SolveWeights, ReproducesAPolynomialOfTheTailExactly) {
  for (const KernelKind kernel : kKernelKinds) {
    Sites sites = smooth_sites(2, 200, 0.0, 1);
    const Eigen::VectorXd tail = random_points(1, tail_size(tail_degree(kernel), 2), 3).transpose();
    sites.target_N = tail_matrix(tail_degree(kernel), sites.points) * tail;
    sites.kernel = kernel;
    const RbfFunction fitted = solved(sites, sites.points.leftCols(20));
    EXPECT_LE((fitted.tail - tail).cwiseAbs().maxCoeff(), 1e-10) << kernel_name(kernel);
    EXPECT_LE(fitted.weights.cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(PenalisedWeights, WithEverySiteACentreItIsTheSmoothingSpline) {
  Sites sites = smooth_sites(2, 120, 0.1, 7);
  for (const KernelKind kernel : {KernelKind::cubic, KernelKind::linear, KernelKind::thin_plate}) {
    for (const double smoothing : {1e-2, 1.0}) {
      sites.kernel = kernel;
      sites.smoothing = smoothing;
      const auto some = solved(sites, sites.points);
      const Result all = test::must(solve_direct(sites));
      // Two algorithms for systems with condition numbers up to some 1e6.
      EXPECT_LT(test::largest_difference(some, all->function(), sites.points), 1e-7) << kernel_name(kernel);
    }
  }
}

// Eq. 8 and the rows of the side condition (eq. 3), literally.
struct PseudoInverse {
  Eigen::VectorXd weights_and_tail;
  Eigen::Index rank = 0;
  double condition_number = 0.0;
};
PseudoInverse pseudo_inverse(const Sites& sites, const Eigen::MatrixXd& centres) {
  const Eigen::MatrixXd tail = tail_matrix(tail_degree(sites.kernel), centres);
  const Eigen::MatrixXd rows = naive_matrix(sites, sites.kernel, centres);
  Eigen::MatrixXd stack = Eigen::MatrixXd::Zero(rows.rows() + tail.cols(), rows.cols());
  stack.topRows(rows.rows()) = rows;
  stack.bottomLeftCorner(tail.cols(), centres.cols()) = tail.transpose();
  Eigen::VectorXd data = Eigen::VectorXd::Zero(stack.rows());
  data.head(rows.rows()) = sites.target_N.cwiseProduct(sites.row_scale);
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(stack, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd values = svd.singularValues();
  PseudoInverse result{Eigen::VectorXd::Zero(stack.cols())};
  for (; result.rank < values.size() && values(result.rank) > sites.truncation * values(0); ++result.rank) {
    const double share = svd.matrixU().col(result.rank).dot(data) / values(result.rank);
    result.weights_and_tail += share * svd.matrixV().col(result.rank);
  }
  result.condition_number = values(0) / values(result.rank - 1);
  return result;
}

TEST(TruncatedWeights, AreThoseOfThePapersPseudoInverse) {
  for (const KernelKind kernel : kKernelKinds) {
    Sites sites = smooth_sites(2, 300, 0.01, 3);
    sites.kernel = kernel;
    Eigen::MatrixXd centres = sites.points.leftCols(30);
    centres.col(29) = centres.col(0);
    Eigen::Index rank_before = 0;
    for (const double truncation : {1e-2, 1e-4, 1e-9}) {
      sites.truncation = truncation;
      const FittedCorrection solved = solve_weights(sites, centres);
      const PseudoInverse expected = pseudo_inverse(sites, centres);
      SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + std::to_string(truncation));
      EXPECT_EQ(solved.rank, expected.rank);
      EXPECT_GE(solved.rank, rank_before) << "a smaller cut keeps at least as much";
      rank_before = solved.rank;
      EXPECT_NEAR(solved.condition_number, expected.condition_number, 1e-8 * expected.condition_number);
      EXPECT_LT(solved.condition_number, 1.0 / truncation);
      // Rounding of the largest value over the smallest that is kept.
      const double tolerance = 1e-13 * expected.condition_number * expected.weights_and_tail.norm();
      EXPECT_LT((solved.function().weights - expected.weights_and_tail.head(30)).norm(), tolerance);
      EXPECT_LT((solved.function().tail - expected.weights_and_tail.tail(solved.function().tail.size())).norm(),
                tolerance);
    }
    // 30 centres of which two coincide.
    EXPECT_EQ(rank_before, 29 + tail_size(tail_degree(kernel), 2)) << kernel_name(kernel);
  }
}

// Compares fits and values with those of scipy, from tests/golden/rbf_scipy.py.

Eigen::MatrixXd columns_of(const nlohmann::json& rows) {
  Eigen::MatrixXd points(static_cast<Eigen::Index>(rows.at(0).size()), static_cast<Eigen::Index>(rows.size()));
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    for (Eigen::Index k = 0; k < points.rows(); ++k)
      points(k, i) = rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(k)).get<double>();
  return points;
}

Eigen::VectorXd vector_of(const nlohmann::json& values) {
  Eigen::VectorXd vector(static_cast<Eigen::Index>(values.size()));
  for (Eigen::Index i = 0; i < vector.size(); ++i) vector[i] = values.at(static_cast<std::size_t>(i)).get<double>();
  return vector;
}

// The condition number of the matrix of a direct fit, in the 1-norm.
double condition_of(const Sites& sites) {
  const ProjectedKernel projected(sites.kernel, sites.points, sites.row_scale);
  const double smoothing = std::max(sites.smoothing, projected.smallest_smoothing());
  Eigen::MatrixXd matrix = projected.matrix(projected.mean_eigenvalue(), smoothing);
  matrix.triangularView<Eigen::StrictlyUpper>() = matrix.transpose();
  return 1.0 / matrix.partialPivLu().rcond();
}

class AgainstScipy : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ifstream file(std::filesystem::path(PALPATE_SOURCE_DIR) / "tests/golden/rbf_scipy.json");
    ASSERT_TRUE(file.is_open());
    golden_ = nlohmann::json::parse(file);
    ASSERT_EQ(golden_.at("cases").size(), 12U);
  }
  nlohmann::json golden_;
};

TEST_F(AgainstScipy, EvaluatesScipysWeightsToScipysValues) {
  for (const auto& item : golden_.at("cases")) {
    const Eigen::VectorXd tail = vector_of(item.at("tail"));
    const RbfFunction function{*kernel_from_name(item.at("kernel").get<std::string>()), columns_of(item.at("points")),
                               vector_of(item.at("weights")), tail};
    Eigen::VectorXd values;
    RbfCorrection(function).evaluate_many(columns_of(item.at("queries")), values);
    // 32 eps of the sum of absolute terms; distances are below 4.4, so a kernel is below 86.
    const double terms = function.weights.cwiseAbs().sum() * 86.0 + tail.cwiseAbs().sum();
    EXPECT_LE((values - vector_of(item.at("values"))).cwiseAbs().maxCoeff(), 64 * 0x1p-53 * terms);
  }
}

// Two backward stable solvers, one with the minimum smoothing (1e-15 of the
// trace), agree to some 100 eps times the condition number. That is 1e-10 or
// better with smoothing.
TEST_F(AgainstScipy, FitsTheSameWeightsTailAndValues) {
  for (const auto& item : golden_.at("cases")) {
    Sites sites;
    sites.points = columns_of(item.at("points"));
    sites.target_N = vector_of(item.at("forces"));
    sites.row_scale = Eigen::VectorXd::Ones(sites.count());
    const std::string name = item.at("kernel").get<std::string>();
    const double smoothing = item.at("smoothing").get<double>();
    sites.smoothing = smoothing;
    sites.kernel = *kernel_from_name(name);
    const Result solved = test::must(solve_direct(sites));
    const RbfFunction& fitted = solved->function();
    SCOPED_TRACE(name + ", " + std::to_string(sites.dimension()) + "-D, smoothing " + std::to_string(smoothing));
    const double tolerance = 1e-13 * condition_of(sites);
    const Eigen::VectorXd weights = vector_of(item.at("weights"));
    const double size = weights.cwiseAbs().maxCoeff();
    EXPECT_LE((fitted.weights - weights).cwiseAbs().maxCoeff(), tolerance * size);
    const Eigen::VectorXd tail = vector_of(item.at("tail"));
    EXPECT_LE((fitted.tail - tail).cwiseAbs().maxCoeff(), tolerance * (1.0 + size));
    Eigen::VectorXd values;
    RbfCorrection(fitted).evaluate_many(columns_of(item.at("queries")), values);
    const Eigen::VectorXd expected = vector_of(item.at("values"));
    EXPECT_LE((values - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff());
  }
}

}  // namespace
}  // namespace palpate
