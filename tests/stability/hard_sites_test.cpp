// The sites of hard_cases.h.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/base/random_stream.h"
#include "engine/base/text.h"
#include "models/correction/methods.h"
#include "models/fit/correction_choice.h"
#include "tests/stability/hard_cases.h"

namespace palpate::test {
namespace {

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
    cases.push_back(make_case("clusters " + general(width, 2) + " apart", [width](Points& p) {
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

// The smoothing that the program selects: by cross-validation, with consecutive quarters of the sites as strokes.
// Strokes over the same points, as in the clusters, determine the force between the points least.
double selected_smoothing(const Sites& sites) {
  constexpr Eigen::Index kStrokes = 4;
  const Eigen::Index n = sites.count();
  CrossValidationRows rows;
  rows.points = sites.points;
  rows.force_N = sites.target_N;
  rows.depth_m = Eigen::VectorXd::Constant(n, 1e-3);
  rows.row_scale = sites.row_scale;
  rows.trend_N = Eigen::MatrixXd::Zero(n, kStrokes);
  rows.no_force.assign(static_cast<std::size_t>(n), 0);
  for (Eigen::Index i = 0; i < n; ++i) rows.fold.push_back(static_cast<int>(kStrokes * i / n));
  rows.find_distances();
  ModelData common;
  common.correction_limit_N = 10.0;  // above every force of these cases
  common.cover = {{}, 1e12, 2e12};   // every site within reach
  return choose_correction(rows, common).smoothing;
}

Result<FittedCorrection> fit_site_case(const SiteCase& one, const Method& method) {
  const Eigen::VectorXd jnd_N = one.sites.row_scale.cwiseInverse();
  MethodRequest request;
  request.method = &method;
  request.centres = static_cast<int>(one.centres);
  request.grid.assign(kDimension, kGridNodes);
  Sites sites = one.sites;
  sites.smoothing = selected_smoothing(sites);
  return fit_correction({sites, jnd_N, request});
}

HardCase evaluate_site_case(const SiteCase& one, const Method& method) {
  HardCase result;
  result.method = method.name;
  const Result<FittedCorrection> fitted = fit_site_case(one, method);
  if (!fitted) {
    result.refusal = fitted.error().message;
    return result;
  }
  if (!fitted->correction) return result;  // the trend alone, which is not fitted to sites
  const bool zero = one.sites.target_N.isZero();
  const double low_N = one.sites.target_N.minCoeff();
  const double high_N = one.sites.target_N.maxCoeff();
  const double margin_N = kForceMargin * (high_N - low_N) + JndLine{}.at(high_N);
  for (Eigen::Index i = 0; i < one.held_out.cols(); ++i) {
    const double value_N = fitted->correction->evaluate(one.held_out.col(i).data());
    // The true force is a function of the coordinates before scaling.
    Eigen::VectorXd x = one.held_out.col(i);
    if (std::abs(x[1]) > 10.0) x[1] *= 1e-9;
    result.add(value_N, zero ? 0.0 : true_force_N(x), low_N - margin_N, high_N + margin_N);
  }
  return result;
}

TEST(HardCases, EveryMethodIsSafeWithEverySetOfSites) {
  for (const SiteCase& one : site_cases()) {
    std::vector<HardCase> cases;
    for (const Method* method : methods()) cases.push_back(evaluate_site_case(one, *method));
    expect_safe(one.name, cases);
  }
}

}  // namespace
}  // namespace palpate::test
