#include "models/fit/correction_strength.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/base/parallel.h"
#include "engine/base/random_stream.h"
#include "models/solve/lapack.h"
#include "models/solve/penalised_weights.h"
#include "models/model/nearest_points.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/training/weighting.h"

namespace palpate {
namespace {

constexpr Eigen::Index kCentres = 200;
constexpr Eigen::Index kMostSites = 4000;  // of each Gram matrix: more tell the same
constexpr int kLowestDecade = -9;          // of the smoothing, relative to the mean eigenvalue
constexpr int kHighestDecade = 1;
constexpr std::array kStrengths{1.0, 0.75, 0.5, 0.25};
constexpr std::array kRadiusFactors{1.0, 2.0, 4.0, 8.0};

// The left-out fits for every smoothing.
class LeftOutFits {
 public:
  explicit LeftOutFits(const StrengthInput& input) : input_(input), sites_(even_subset(input.sites, kMostSites)) {
    choose_centres();
    space_ = penalty_space(input.kernel, centres_);
    unit_ = mean_eigenvalue();
    columns_ = design(sites_.points);
    columns_.array().colwise() *= sites_.row_scale.array();
    gather();
  }

  double unit() const { return unit_; }

  // The correction at every sample, from the sites of the other folds.
  Eigen::VectorXd predictions(double smoothing) const {
    const Eigen::Index free = space_.penalty.cols();
    Eigen::VectorXd values = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(input_.samples.size()));
    const BlasThreads one_thread(1);
    parallel_for(input_.folds, [&](int fold) {
      const auto k = static_cast<std::size_t>(fold);
      Eigen::MatrixXd matrix = total_gram_ - grams_[k];
      matrix.topLeftCorner(free, free) += smoothing * space_.penalty;
      const Eigen::VectorXd coefficients = solve(std::move(matrix), total_right_ - rights_[k]);
      for (const Eigen::Index i : samples_of_[k]) values(i) = sample_columns_.row(i).dot(coefficients);
    });
    return values;
  }

 private:
  void choose_centres() {
    const Eigen::Index count = std::min(kCentres, std::max<Eigen::Index>(1, sites_.count() / 4));
    std::vector<Eigen::Index> order = distinct_sites(sites_);
    const Eigen::Index used = std::min(count, static_cast<Eigen::Index>(order.size()));
    SplitMix64 random(1);
    centres_.resize(sites_.dimension(), used);
    for (Eigen::Index j = 0; j < used; ++j) {
      const auto left = static_cast<std::uint64_t>(static_cast<Eigen::Index>(order.size()) - j);
      std::swap(order[static_cast<std::size_t>(j)], order[static_cast<std::size_t>(j) + static_cast<std::size_t>(random.below(left))]);
      centres_.col(j) = sites_.points.col(order[static_cast<std::size_t>(j)]);
    }
  }

  // Of the scaled kernel between all sites: the unit of the smoothing.
  double mean_eigenvalue() const {
    const double trace = space_.penalty.trace();
    const double rows = std::max(1.0, static_cast<double>(centres_.cols()));
    const double mean_scale = sites_.row_scale.squaredNorm() / static_cast<double>(sites_.count());
    const double value = trace / rows * mean_scale;
    return value > 0.0 ? value : 1.0;
  }

  // [K Z, G] at the points.
  Eigen::MatrixXd design(const Eigen::MatrixXd& points) const {
    Eigen::MatrixXd kernel(points.cols(), centres_.cols());
    kernel_matrix(input_.kernel, PointArrays(points), centres_, kernel);
    const Eigen::MatrixXd tail = tail_matrix(tail_degree(input_.kernel), points);
    Eigen::MatrixXd all(points.cols(), space_.basis.cols() + tail.cols());
    multiply(kernel, false, space_.basis, false, 1.0, 0.0, all.leftCols(space_.basis.cols()));
    all.rightCols(tail.cols()) = tail;
    return all;
  }

  void gather() {
    const auto n = static_cast<Eigen::Index>(columns_.cols());
    const Eigen::VectorXd data = sites_.row_scale.cwiseProduct(sites_.target_N);
    total_gram_ = Eigen::MatrixXd::Zero(n, n);
    total_right_ = Eigen::VectorXd::Zero(n);
    samples_of_.resize(static_cast<std::size_t>(input_.folds));
    for (int k = 0; k < input_.folds; ++k) {
      std::vector<Eigen::Index> rows;
      for (std::size_t i = 0; i < sites_.group.size(); ++i) {
        if (sites_.group[i] == k) rows.push_back(static_cast<Eigen::Index>(i));
      }
      const Eigen::MatrixXd part = columns_(rows, Eigen::all);
      Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
      if (part.rows() > 0) multiply(part, true, part, false, 1.0, 0.0, gram);
      const Eigen::VectorXd right = part.transpose() * data(rows);
      total_gram_ += gram;
      total_right_ += right;
      grams_.push_back(std::move(gram));
      rights_.push_back(right);
    }
    Eigen::MatrixXd points(sites_.dimension(), static_cast<Eigen::Index>(input_.samples.size()));
    for (std::size_t i = 0; i < input_.samples.size(); ++i) {
      points.col(static_cast<Eigen::Index>(i)) = input_.samples[i].point;
      samples_of_[static_cast<std::size_t>(input_.samples[i].fold)].push_back(static_cast<Eigen::Index>(i));
    }
    sample_columns_ = design(points);
  }

  static Eigen::VectorXd solve(Eigen::MatrixXd matrix, Eigen::VectorXd right) {
    Eigen::VectorXd scale = matrix.diagonal();
    for (double& value : scale) value = value > 0.0 ? 1.0 / std::sqrt(value) : 0.0;
    matrix = (scale.asDiagonal() * matrix * scale.asDiagonal()).eval();
    right = right.cwiseProduct(scale).eval();
    for (double lift = 1e-14; lift < 1.0; lift *= 100.0) {
      Eigen::MatrixXd factor = matrix;
      factor.diagonal().array() += lift;
      if (!cholesky_in_place(factor)) continue;
      cholesky_solve(factor, right);
      return right.cwiseProduct(scale);
    }
    return Eigen::VectorXd::Zero(right.size());
  }

  const StrengthInput& input_;
  Sites sites_;
  Eigen::MatrixXd centres_;
  PenaltySpace space_;
  double unit_ = 1.0;
  Eigen::MatrixXd columns_;
  Eigen::MatrixXd sample_columns_;
  Eigen::MatrixXd total_gram_;
  Eigen::VectorXd total_right_;
  std::vector<Eigen::MatrixXd> grams_;
  std::vector<Eigen::VectorXd> rights_;
  std::vector<std::vector<Eigen::Index>> samples_of_;
};

// Distance of every sample to the nearest site of another fold.
std::vector<double> distances(const StrengthInput& input) {
  std::vector<double> result(input.samples.size(), std::numeric_limits<double>::infinity());
  for (int k = 0; k < input.folds; ++k) {
    std::vector<Eigen::Index> others;
    for (std::size_t i = 0; i < input.sites.group.size(); ++i) {
      if (input.sites.group[i] != k) others.push_back(static_cast<Eigen::Index>(i));
    }
    if (others.empty()) continue;
    const NearestDistance nearest(input.sites.points(Eigen::all, others));
    for (std::size_t i = 0; i < input.samples.size(); ++i) {
      if (input.samples[i].fold == k) result[i] = std::sqrt(nearest.nearest_squared(input.samples[i].point.data()));
    }
  }
  return result;
}

double trust(double distance, double inner, double outer) {
  if (!(distance < outer)) return 0.0;
  if (distance <= inner) return 1.0;
  const double t = (outer - distance) / (outer - inner);
  return t * t * (3.0 - 2.0 * t);
}

// Samples that count: not deeper than every site of the other folds.
std::vector<char> inside_depth(const StrengthInput& input) {
  std::vector<double> deepest_m(static_cast<std::size_t>(input.folds), 0.0);
  for (const LeftOutSample& sample : input.samples) {
    double& deepest = deepest_m[static_cast<std::size_t>(sample.fold)];
    deepest = std::max(deepest, sample.depth_m);
  }
  std::vector<char> counts;
  for (const LeftOutSample& sample : input.samples) {
    double elsewhere_m = 0.0;
    for (std::size_t k = 0; k < deepest_m.size(); ++k) {
      if (static_cast<int>(k) != sample.fold) elsewhere_m = std::max(elsewhere_m, deepest_m[k]);
    }
    counts.push_back(sample.depth_m <= elsewhere_m ? 1 : 0);
  }
  return counts;
}

// Errors that are felt anyhow all count much the same.
double saturated_square(double error_over_jnd) {
  const double scaled = error_over_jnd * robust_scale(error_over_jnd);
  return scaled * scaled;
}

struct Variant {
  double smoothing = 0.0;
  double strength = 0.0;
  double inner_radius = 0.0;
  std::vector<double> fold_squares;  // of error over JND, over all samples
  double total() const {
    double sum = 0.0;
    for (const double value : fold_squares) sum += value;
    return sum;
  }
};

double force_of(const LeftOutSample& sample, const StrengthInput& input, double strength, double trusted, double h) {
  const double limit = input.correction_limit_N;
  return std::max(0.0, sample.trend_N + strength * trusted * std::clamp(h, -limit, limit));
}

// Standard error of the sum of the differences between two variants.
double standard_error(const std::vector<double>& a, const std::vector<double>& b) {
  const auto folds = static_cast<double>(a.size());
  if (folds < 2.0) return 0.0;
  double mean = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) mean += (a[k] - b[k]) / folds;
  double squares = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double rest = a[k] - b[k] - mean;
    squares += rest * rest;
  }
  return std::sqrt(squares * folds / (folds - 1.0));
}

}  // namespace

bool is_better(const StrengthChoice& a, const StrengthChoice& b) {
  if (a.fold_squares.size() != b.fold_squares.size()) return false;
  double gain = 0.0;
  for (std::size_t k = 0; k < a.fold_squares.size(); ++k) gain += b.fold_squares[k] - a.fold_squares[k];
  return gain > 0.5 * standard_error(a.fold_squares, b.fold_squares);
}

StrengthChoice choose_strength(const StrengthInput& input) {
  StrengthChoice choice;
  choice.inner_radius = input.least_radius;
  choice.strength = 0.0;
  if (input.samples.empty() || input.sites.count() < 2 || input.folds < 2) return choice;
  const BlasThreads one_thread(1);
  const LeftOutFits fits(input);
  const std::vector<double> distance = distances(input);
  const std::vector<char> counts = inside_depth(input);
  std::vector<Variant> variants;
  std::vector<Eigen::VectorXd> predictions;
  const auto score = [&](double smoothing, double strength, double radius, const Eigen::VectorXd& h) {
    Variant variant{smoothing, strength, radius, std::vector<double>(static_cast<std::size_t>(input.folds), 0.0)};
    for (std::size_t i = 0; i < input.samples.size(); ++i) {
      if (!counts[i]) continue;
      const LeftOutSample& sample = input.samples[i];
      const double trusted = trust(distance[i], radius, input.outer_to_inner * radius);
      const double force_N = force_of(sample, input, strength, trusted, h(static_cast<Eigen::Index>(i)));
      const double error = input.jnd.error_over_jnd(force_N, sample.force_N);
      variant.fold_squares[static_cast<std::size_t>(sample.fold)] += saturated_square(error);
    }
    variants.push_back(std::move(variant));
  };
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(input.samples.size()));
  score(fits.unit(), 0.0, input.least_radius, nothing);
  for (int decade = kHighestDecade; decade >= kLowestDecade; --decade) {
    const double smoothing = fits.unit() * std::pow(10.0, decade);
    predictions.push_back(fits.predictions(smoothing));
    for (const double factor : kRadiusFactors) {
      for (const double strength : kStrengths) score(smoothing, strength, factor * input.least_radius, predictions.back());
    }
  }
  const auto best = std::min_element(variants.begin(), variants.end(),
                                     [](const Variant& a, const Variant& b) { return a.total() < b.total(); });
  // "None" if it is as good; else the most smoothing that is.
  const Variant* chosen = &*best;
  for (const Variant& variant : variants) {
    if (variant.strength != best->strength && variant.strength != 0.0) continue;
    if (variant.inner_radius != best->inner_radius && variant.strength != 0.0) continue;
    if (variant.total() - best->total() <= standard_error(variant.fold_squares, best->fold_squares)) {
      chosen = &variant;
      break;
    }
  }
  double counted = 0.0;
  for (const char one : counts) counted += one;
  counted = std::max(counted, 1.0);
  choice.smoothing = chosen->smoothing;
  choice.strength = chosen->strength;
  choice.inner_radius = chosen->inner_radius;
  choice.fold_squares = chosen->fold_squares;
  choice.trend_error_over_jnd = std::sqrt(variants.front().total() / counted);
  choice.error_over_jnd = std::sqrt(chosen->total() / counted);
  const Eigen::VectorXd h = chosen->strength > 0.0 ? fits.predictions(chosen->smoothing) : nothing;
  for (std::size_t i = 0; i < input.samples.size(); ++i) {
    if (!std::isfinite(distance[i])) continue;
    const LeftOutSample& sample = input.samples[i];
    const double trusted = trust(distance[i], chosen->inner_radius, input.outer_to_inner * chosen->inner_radius);
    const double force_N = force_of(sample, input, chosen->strength, trusted, h(static_cast<Eigen::Index>(i)));
    choice.predictions.push_back({i, std::abs(force_N - sample.force_N), force_N, distance[i]});
    const double trend_N = force_of(sample, input, 0.0, 0.0, 0.0);
    choice.trend_predictions.push_back({i, std::abs(trend_N - sample.force_N), trend_N, distance[i]});
  }
  return choice;
}

}  // namespace palpate
