// The site cases of hard_cases.h.
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

#include "engine/base/random_stream.h"
#include "engine/tick/jnd.h"
#include "models/fit/methods.h"
#include "models/linear/lapack.h"
#include "models/model/rbf/polynomial_tail.h"
#include "tests/stability/hard_cases.h"
#include "tests/stability/hard_outcome.h"

namespace palpate {
namespace {

// "3.2e-05"
std::string two_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

using Points = Eigen::MatrixXd;

constexpr int kDimension = 3;
constexpr int kSites = 160;
constexpr int kHeldOut = 200;
constexpr int kGridNodes = 15;  // along each feature
constexpr double kNoise_N = 0.005;

struct SiteCase {
  std::string name;
  Sites sites;
  Points held_out;
  Eigen::Index centres = 60;
};

double true_force_N(const Eigen::VectorXd& x) {
  double force_N = 2.0;
  for (Eigen::Index k = 0; k < x.size(); ++k) force_N += 0.5 * std::sin((1.0 + 0.4 * static_cast<double>(k)) * x[k]);
  return force_N + 0.2 * x[0] * x[x.size() - 1];
}

Points even_points(Eigen::Index count, std::uint64_t stream) {
  RandomStream random(7, stream);
  Points points(kDimension, count);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = random.uniform(-1.0, 1.0);
  return points;
}

// `shape` maps uniform points of a cube to those of the case. The force is
// true_force_N() of the mapped point.
SiteCase make_case(const std::string& name, const std::function<void(Points&)>& shape, Eigen::Index count = kSites,
                   Eigen::Index centres = 60) {
  SiteCase made;
  made.name = name;
  made.centres = centres;
  made.sites.points = even_points(count, 1);
  made.held_out = even_points(kHeldOut, 2);
  shape(made.sites.points);
  shape(made.held_out);
  made.sites.target_N.resize(count);
  made.sites.row_scale.resize(count);
  RandomStream noise(7, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double force_N = true_force_N(made.sites.points.col(i));
    made.sites.target_N[i] = force_N + kNoise_N * noise.normal();
    made.sites.row_scale[i] = 1.0 / JndLine{}.at(force_N);
  }
  return made;
}

// Few sites do not determine the force at other points, so the fit is evaluated at the sites.
SiteCase few(Eigen::Index count) {
  SiteCase made = make_case(
      "N = " + std::to_string(count), [](Points&) {}, count);
  made.held_out = made.sites.points;
  return made;
}

void same(Points&) {}

std::vector<SiteCase> site_cases() {
  std::vector<SiteCase> cases;
  cases.push_back(make_case("exact duplicates", [](Points& p) {
    const Eigen::Index half = p.cols() / 2;
    p.rightCols(half) = p.leftCols(half).eval();
  }));
  cases.push_back(cases.back());
  cases.back().name = "duplicates that disagree by 0.1 N";
  cases.back().sites.target_N.tail(kSites / 2).array() += 0.05;
  cases.back().sites.target_N.head(kSites / 2).array() -= 0.05;
  cases.push_back(make_case("clusters 1e-9 apart", [](Points& p) {
    for (Eigen::Index i = 0; i < p.cols(); ++i) p.col(i) = p.col(i % 40) + 1e-9 * p.col(i);
  }));
  for (const double width : {1e-7, 1e-5, 1e-3})
    cases.push_back(make_case("clusters " + two_digits(width) + " apart", [width](Points& p) {
      for (Eigen::Index i = 0; i < p.cols(); ++i) p.col(i) = p.col(i % 40) + width * p.col(i);
    }));
  cases.push_back(make_case("on a line", [](Points& p) {
    for (Eigen::Index i = 0; i < p.cols(); ++i) p.col(i) = p(0, i) * Eigen::Vector3d(1.0, -0.7, 0.4);
  }));
  cases.push_back(make_case("on a plane", [](Points& p) { p.row(2) = 0.3 * p.row(0) - 0.8 * p.row(1); }));
  cases.push_back(make_case("a constant feature", [](Points& p) { p.row(1).setConstant(-0.3); }));
  cases.push_back(
      make_case("all sites at one point", [](Points& p) { p.colwise() = Eigen::Vector3d(0.2, -0.1, 0.5); }));
  cases.push_back(make_case("ranges that differ by 1e9", same));
  cases.back().sites.points.row(1) *= 1e9;
  cases.back().held_out.row(1) *= 1e9;
  cases.push_back(few(1));
  cases.push_back(few(2));
  cases.push_back(few(kDimension + 1));
  cases.push_back(make_case("one centre", same, kSites, 1));
  cases.push_back(make_case("as many centres as sites", same, kSites, kSites));
  cases.push_back(make_case("more centres than sites", same, kSites, 2 * kSites));
  cases.push_back(make_case("saddle matrix beyond 1e16", [](Points& p) {
    for (Eigen::Index i = 0; i < p.cols(); ++i)
      if (i % 8 != 0) p.col(i) *= 1e-5;
  }));
  cases.push_back(make_case("all forces zero", same));
  cases.back().sites.target_N.setZero();
  return cases;
}

Result<FittedCorrection> fit_site_case(const SiteCase& one, const Method& method) {
  const Eigen::VectorXd jnd_N = one.sites.row_scale.cwiseInverse();
  MethodRequest request;
  request.method = &method;
  request.centres = static_cast<int>(one.centres);
  request.grid.assign(kDimension, kGridNodes);
  return fit_correction({one.sites, jnd_N, request});
}

Eigen::VectorXd values_at(const Points& points, const Correction& correction) {
  Eigen::VectorXd values(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) values[i] = correction.evaluate(points.col(i).data());
  return values;
}

using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

// The system of eq. 4 with the smoothing on its diagonal.
Long saddle_matrix(const Sites& sites, double smoothing) {
  const Eigen::Index n = sites.count();
  const Eigen::MatrixXd tail = tail_matrix(1, sites.points);
  Long matrix = Long::Zero(n + tail.cols(), n + tail.cols());
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const long double squared =
          (sites.points.col(i).cast<long double>() - sites.points.col(j).cast<long double>()).squaredNorm();
      matrix(i, j) = squared * std::sqrt(squared);
    }
  for (Eigen::Index i = 0; i < n; ++i)
    matrix(i, i) +=
        static_cast<long double>(smoothing) / (static_cast<long double>(sites.row_scale[i]) * sites.row_scale[i]);
  matrix.topRightCorner(n, tail.cols()) = tail.cast<long double>();
  matrix.bottomLeftCorner(tail.cols(), n) = tail.transpose().cast<long double>();
  return matrix;
}

// "saddle matrix of condition 3e+18; 2e-09 JND from long double".
std::string compare_with_reference(const SiteCase& one, double smoothing, const Eigen::VectorXd& values) {
  const Eigen::Index n = one.sites.count();
  const Eigen::BDCSVD<Eigen::MatrixXd> parts(saddle_matrix(one.sites, 0.0).cast<double>());
  const auto& singular = parts.singularValues();
  std::string text =
      "; saddle matrix of condition " + two_digits(singular[0] / std::max(singular[singular.size() - 1], 1e-300));
  Long matrix = saddle_matrix(one.sites, smoothing);
  Long right = Long::Zero(matrix.rows(), 1);
  right.topRows(n) = one.sites.target_N.cast<long double>();
  // Equilibrates rows and columns (Ruiz 2001), so that the numerical rank does
  // not depend on units.
  Long scale = Long::Ones(matrix.rows(), 1);
  for (int pass = 0; pass < 12; ++pass) {
    const Long factor = matrix.cwiseAbs().rowwise().maxCoeff().cwiseMax(1e-300L).cwiseSqrt().cwiseInverse();
    matrix = factor.asDiagonal() * matrix * factor.asDiagonal();
    scale = scale.cwiseProduct(factor);
  }
  right = scale.asDiagonal() * right;
  const Long solution = scale.asDiagonal() * Long(matrix.fullPivLu().solve(right));
  double worst = 0.0;
  for (Eigen::Index i = 0; i < one.held_out.cols(); ++i) {
    long double sum = solution(n, 0);
    for (Eigen::Index k = 0; k < kDimension; ++k) sum += solution(n + 1 + k, 0) * one.held_out(k, i);
    for (Eigen::Index j = 0; j < n; ++j) {
      const long double squared =
          (one.held_out.col(i).cast<long double>() - one.sites.points.col(j).cast<long double>()).squaredNorm();
      sum += solution(j, 0) * squared * std::sqrt(squared);
    }
    worst = std::max(worst, std::abs(static_cast<double>(sum) - values[i]) / JndLine{}.at(static_cast<double>(sum)));
  }
  return text + ", " + two_digits(worst) + " JND from its solution in long double";
}

HardCaseResult evaluate_site_case(const SiteCase& one, const Method& method) {
  HardCaseResult result;
  result.name = one.name;
  result.method = method.name;
  const Result<FittedCorrection> fitted = fit_site_case(one, method);
  if (!fitted) return refused(std::move(result), fitted.error().message);
  result.condition = fitted->report.condition;
  result.residual = fitted->report.residual_rms;
  result.smoothing = fitted->report.smoothing;
  if (fitted->correction->is_none()) {
    result.outcome = "the trend alone, which is not fitted to sites";
    result.safe = true;
    return result;
  }
  const Eigen::VectorXd values = values_at(one.held_out, *fitted->correction);
  const bool zero = one.sites.target_N.isZero();
  const double low_N = one.sites.target_N.minCoeff();
  const double high_N = one.sites.target_N.maxCoeff();
  const double margin_N = 1.2 * (high_N - low_N) + JndLine{}.at(high_N);
  OutcomeCounter counter;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    // The true force is a function of the coordinates before scaling.
    Eigen::VectorXd x = one.held_out.col(i);
    if (std::abs(x[1]) > 10.0) x[1] *= 1e-9;
    const double truth_N = zero ? 0.0 : true_force_N(x);
    counter.add(values[i], truth_N, low_N - margin_N, high_N + margin_N);
  }
  result = counter.finish(std::move(result));
  const bool direct = &method == &kDirectMethod;
  if (direct && !fitted->report.notes.empty()) result.outcome += "; " + fitted->report.notes[0];
  if (direct) result.outcome += compare_with_reference(one, fitted->report.smoothing, values);
  return result;
}

}  // namespace

std::vector<HardCaseResult> run_hard_sites() {
  std::vector<HardCaseResult> results;
  for (const SiteCase& one : site_cases())
    for (const Method* method : methods()) results.push_back(evaluate_site_case(one, *method));
  return results;
}

}  // namespace palpate
