// Compares fits and values with those of scipy, from tests/golden/rbf_scipy.py.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "models/correction/algebra.h"
#include "models/model/correction.h"

namespace palpate {
namespace {

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
    const auto solved = solve_direct(sites);
    ASSERT_TRUE(solved.ok());
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
