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
    points_.resize(sites_.dimension(), static_cast<Eigen::Index>(input_.samples.size()));
    for (std::size_t i = 0; i < input_.samples.size(); ++i) {
      points_.col(static_cast<Eigen::Index>(i)) = input_.samples[i].point;
    }
    samples_of_.resize(static_cast<std::size_t>(input_.folds));
    for (std::size_t i = 0; i < input_.samples.size(); ++i) {
      samples_of_[static_cast<std::size_t>(input_.samples[i].fold)].push_back(static_cast<Eigen::Index>(i));
    }
  }

  // Before the first prediction both of these, which touch nothing in common.
  void gather_sites();
  void gather_samples();

  double unit() const { return unit_; }

  // The correction at every sample, from the sites of the other folds.
  Eigen::VectorXd predictions(double smoothing) const {
    Eigen::VectorXd values = Eigen::VectorXd::Zero(points_.cols());
    for (std::size_t k = 0; k < grams_.size(); ++k) {
      const Eigen::VectorXd coefficients = solve(grams_[k], smoothing, total_right_ - rights_[k]);
      // Column by column: the samples of a fold stand below one another.
      Eigen::VectorXd of_fold = Eigen::VectorXd::Zero(sample_columns_[k].rows());
      for (Eigen::Index j = 0; j < coefficients.size(); ++j) of_fold += coefficients(j) * sample_columns_[k].col(j);
      values(samples_of_[k]) = of_fold;
    }
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

  // (`gram` + smoothing * penalty) x = right, scaled to a diagonal of ones.
  Eigen::VectorXd solve(const Eigen::MatrixXd& gram, double smoothing, Eigen::VectorXd right) const {
    const Eigen::Index n = gram.cols();
    const Eigen::Index free = space_.penalty.cols();
    Eigen::VectorXd scale = gram.diagonal();
    scale.head(free) += smoothing * space_.penalty.diagonal();
    for (double& value : scale) value = value > 0.0 ? 1.0 / std::sqrt(value) : 0.0;
    right = right.cwiseProduct(scale).eval();
    Eigen::MatrixXd factor(n, n);
    for (double lift = 1e-14; lift < 1.0; lift *= 100.0) {
      for (Eigen::Index j = 0; j < n; ++j) {  // below the diagonal
        auto column = factor.col(j).tail(n - j);
        column = gram.col(j).tail(n - j);
        if (j < free) column.head(free - j) += smoothing * space_.penalty.col(j).tail(free - j);
        column = (column.cwiseProduct(scale.tail(n - j)) * scale(j)).eval();
      }
      factor.diagonal().array() += lift;
      if (!cholesky_in_place(factor)) continue;
      cholesky_solve(factor, right);
      return right.cwiseProduct(scale);
    }
    return Eigen::VectorXd::Zero(n);
  }

  const StrengthInput& input_;
  Sites sites_;
  Eigen::MatrixXd centres_;
  PenaltySpace space_;
  double unit_ = 1.0;
  Eigen::MatrixXd points_;  // of the samples
  std::vector<Eigen::MatrixXd> sample_columns_;  // by fold
  Eigen::VectorXd total_right_;
  std::vector<Eigen::MatrixXd> grams_;  // without each fold
  std::vector<Eigen::VectorXd> rights_;
  std::vector<std::vector<Eigen::Index>> samples_of_;
};

void LeftOutFits::gather_sites() {
  Eigen::MatrixXd columns = design(sites_.points);
  columns.array().colwise() *= sites_.row_scale.array();
  const auto n = columns.cols();
  const Eigen::VectorXd data = sites_.row_scale.cwiseProduct(sites_.target_N);
  Eigen::MatrixXd total_gram = Eigen::MatrixXd::Zero(n, n);
  total_right_ = Eigen::VectorXd::Zero(n);
  for (int k = 0; k < input_.folds; ++k) {
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < sites_.group.size(); ++i) {
      if (sites_.group[i] == k) rows.push_back(static_cast<Eigen::Index>(i));
    }
    const Eigen::MatrixXd part = columns(rows, Eigen::all);
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(n, n);
    if (part.rows() > 0) multiply(part, true, part, false, 1.0, 0.0, gram);
    const Eigen::VectorXd right = part.transpose() * data(rows);
    total_gram += gram;
    total_right_ += right;
    grams_.push_back(std::move(gram));
    rights_.push_back(right);
  }
  for (Eigen::MatrixXd& gram : grams_) gram = total_gram - gram;
}

void LeftOutFits::gather_samples() {
  const Eigen::MatrixXd columns = design(points_);
  for (const auto& samples : samples_of_) sample_columns_.push_back(columns(samples, Eigen::all));
}

// Distance of every sample of a fold to the nearest site of another fold.
void add_distances(const StrengthInput& input, int fold, std::vector<double>& distance) {
  std::vector<Eigen::Index> others;
  for (std::size_t i = 0; i < input.sites.group.size(); ++i) {
    if (input.sites.group[i] != fold) others.push_back(static_cast<Eigen::Index>(i));
  }
  if (others.empty()) return;
  const NearestDistance nearest(input.sites.points(Eigen::all, others));
  for (std::size_t i = 0; i < input.samples.size(); ++i) {
    if (input.samples[i].fold == fold) distance[i] = std::sqrt(nearest.nearest_squared(input.samples[i].point.data()));
  }
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
  LeftOutFits fits(input);
  std::vector<double> distance(input.samples.size(), std::numeric_limits<double>::infinity());
  parallel_for(2 + input.folds, [&](int part) {
    if (part == 0) return fits.gather_sites();
    if (part == 1) return fits.gather_samples();
    add_distances(input, part - 2, distance);
  });
  const std::vector<char> counts = inside_depth(input);
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
    return variant;
  };
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(input.samples.size()));
  constexpr int kDecades = kHighestDecade - kLowestDecade + 1;
  std::array<Eigen::VectorXd, kDecades> predictions;
  std::array<std::vector<Variant>, kDecades> of_decade;
  parallel_for(kDecades, [&](int part) {
    const auto at = static_cast<std::size_t>(part);
    const double smoothing = fits.unit() * std::pow(10.0, kHighestDecade - part);
    predictions[at] = fits.predictions(smoothing);
    for (const double factor : kRadiusFactors) {
      for (const double strength : kStrengths) {
        of_decade[at].push_back(score(smoothing, strength, factor * input.least_radius, predictions[at]));
      }
    }
  });
  // "None" first, then from the most smoothing to the least.
  std::vector<Variant> variants{score(fits.unit(), 0.0, input.least_radius, nothing)};
  for (const auto& some : of_decade) variants.insert(variants.end(), some.begin(), some.end());
  const auto best = std::min_element(variants.begin(), variants.end(),
                                     [](const Variant& a, const Variant& b) { return a.total() < b.total(); });
  // "None" if it is as good; else the shortest reach that is, and there the most smoothing.
  // (Strokes that are all alike say nothing of how far the correction may reach.)
  const auto as_good = [&](const Variant& variant) {
    if (variant.strength != best->strength && variant.strength != 0.0) return false;
    return variant.total() - best->total() <= standard_error(variant.fold_squares, best->fold_squares);
  };
  const Variant* chosen = &*best;
  for (const Variant& variant : variants) {
    if (!as_good(variant)) continue;
    if (variant.strength == 0.0) {
      chosen = &variant;
      break;
    }
    if (variant.inner_radius < chosen->inner_radius ||
        (variant.inner_radius == chosen->inner_radius && variant.smoothing > chosen->smoothing)) {
      chosen = &variant;
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
  const auto place = static_cast<std::size_t>(chosen - variants.data());
  const std::size_t of_each = kRadiusFactors.size() * kStrengths.size();
  const Eigen::VectorXd& h = place > 0 ? predictions[(place - 1) / of_each] : nothing;
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
