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
constexpr Eigen::Index kBlockRows = 512;   // of the design at a time
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
    folds_.resize(static_cast<std::size_t>(input_.folds));
    sort_sites();
    sort_samples();
    of_sites_.resize(sites_.count(), columns());
    of_samples_.resize(points_.cols(), columns());
  }

  // Before the first prediction all blocks, then all folds; each touches what is its own.
  int blocks() const { return blocks_of(of_sites_) + blocks_of(of_samples_); }
  void gather_block(int block);
  void gather_fold(int fold);
  void finish();

  double unit() const { return unit_; }

  // The correction at every sample, from the sites of the other folds.
  Eigen::VectorXd predictions(double smoothing) const {
    Eigen::VectorXd values = Eigen::VectorXd::Zero(points_.cols());
    for (std::size_t k = 0; k < folds_.size(); ++k) {
      const Fold& fold = folds_[k];
      const Eigen::VectorXd coefficients = solve(fold.gram, smoothing, total_right_ - fold.right);
      const auto count = static_cast<Eigen::Index>(fold.samples.size());
      Eigen::VectorXd of_fold(count);
      multiply(of_samples_.middleRows(fold.first_sample, count), false, coefficients, false, 1.0, 0.0, of_fold);
      values(fold.samples) = of_fold;
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

  struct Fold {
    Eigen::Index first_site = 0;
    Eigen::Index sites = 0;
    Eigen::Index first_sample = 0;      // row of of_samples_
    std::vector<Eigen::Index> samples;  // of the input
    Eigen::MatrixXd gram;               // of all sites but its own; the lower triangle
    Eigen::VectorXd right;              // of its own
  };

  // By fold, so that what belongs to one stands together.
  void sort_sites() {
    Sites sorted = sites_;
    Eigen::Index at = 0;
    for (int k = 0; k < input_.folds; ++k) {
      Fold& fold = folds_[static_cast<std::size_t>(k)];
      fold.first_site = at;
      for (Eigen::Index i = 0; i < sites_.count(); ++i) {
        if (sites_.group[static_cast<std::size_t>(i)] != k) continue;
        sorted.points.col(at) = sites_.points.col(i);
        sorted.target_N(at) = sites_.target_N(i);
        sorted.row_scale(at) = sites_.row_scale(i);
        ++at;
      }
      fold.sites = at - fold.first_site;
    }
    sites_ = std::move(sorted);
  }

  void sort_samples() {
    for (std::size_t i = 0; i < input_.samples.size(); ++i) {
      folds_[static_cast<std::size_t>(input_.samples[i].fold)].samples.push_back(static_cast<Eigen::Index>(i));
    }
    points_.resize(sites_.dimension(), static_cast<Eigen::Index>(input_.samples.size()));
    Eigen::Index at = 0;
    for (Fold& fold : folds_) {
      fold.first_sample = at;
      for (const Eigen::Index i : fold.samples) points_.col(at++) = input_.samples[static_cast<std::size_t>(i)].point;
    }
  }

  static int blocks_of(const Eigen::MatrixXd& all) { return static_cast<int>((all.rows() + kBlockRows - 1) / kBlockRows); }

  Eigen::Index columns() const {
    return space_.free + tail_size(tail_degree(input_.kernel), sites_.dimension());
  }

  // A block of [K Z, G] at the points.
  void design(const Eigen::MatrixXd& points, int block, Eigen::MatrixXd& all) const {
    const Eigen::Index first = block * kBlockRows;
    const Eigen::Index rows = std::min(kBlockRows, points.cols() - first);
    const Eigen::MatrixXd some = points.middleCols(first, rows);
    Eigen::MatrixXd kernel(rows, centres_.cols());
    kernel_matrix(input_.kernel, PointArrays(some), centres_, kernel);
    multiply_by_basis(kernel, space_);
    const Eigen::Index free = space_.free;
    all.block(first, 0, rows, free) = kernel.leftCols(free);
    all.block(first, free, rows, all.cols() - free) = tail_matrix(tail_degree(input_.kernel), some);
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
  Eigen::MatrixXd points_;  // of the samples, by fold
  Eigen::MatrixXd of_sites_;    // [K Z, G], scaled
  Eigen::MatrixXd of_samples_;  // [K Z, G]
  Eigen::VectorXd total_right_;
  std::vector<Fold> folds_;
};

void LeftOutFits::gather_block(int block) {
  const int of_samples = block - blocks_of(of_sites_);
  if (of_samples >= 0) return design(points_, of_samples, of_samples_);
  design(sites_.points, block, of_sites_);
  const Eigen::Index first = block * kBlockRows;
  const Eigen::Index rows = std::min(kBlockRows, sites_.count() - first);
  of_sites_.middleRows(first, rows).array().colwise() *= sites_.row_scale.segment(first, rows).array();
}

// Of its own sites; `finish` makes it that of all others.
void LeftOutFits::gather_fold(int fold) {
  Fold& mine = folds_[static_cast<std::size_t>(fold)];
  mine.gram = Eigen::MatrixXd::Zero(columns(), columns());
  mine.right = Eigen::VectorXd::Zero(columns());
  if (mine.sites == 0) return;
  const auto part = of_sites_.middleRows(mine.first_site, mine.sites);
  const Eigen::VectorXd data = sites_.row_scale.segment(mine.first_site, mine.sites)
                                   .cwiseProduct(sites_.target_N.segment(mine.first_site, mine.sites));
  gram(part, mine.gram);
  multiply(part, true, data, false, 1.0, 0.0, mine.right);
}

void LeftOutFits::finish() {
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(columns(), columns());
  total_right_ = Eigen::VectorXd::Zero(columns());
  for (const Fold& fold : folds_) {
    total += fold.gram;
    total_right_ += fold.right;
  }
  for (Fold& fold : folds_) fold.gram = total - fold.gram;
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

// Of error over JND, as weighting.h's robust_scale leaves it: errors that are felt anyhow
// all count much the same.
double saturated_square(double error_over_jnd) {
  const double squared = error_over_jnd * error_over_jnd;
  return squared / (1.0 + squared / (kRobustError_jnd * kRobustError_jnd));
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
  parallel_for(fits.blocks(), [&](int block) { fits.gather_block(block); });
  parallel_for(2 * input.folds, [&](int part) {
    if (part < input.folds) return fits.gather_fold(part);
    add_distances(input, part - input.folds, distance);
  });
  fits.finish();
  const std::vector<char> counts = inside_depth(input);
  // Once for all variants.
  std::array<std::vector<double>, kRadiusFactors.size()> trusted;
  std::vector<double> inverse_jnd;
  for (const LeftOutSample& sample : input.samples) inverse_jnd.push_back(1.0 / input.jnd.at(sample.force_N));
  for (std::size_t r = 0; r < kRadiusFactors.size(); ++r) {
    const double radius = kRadiusFactors[r] * input.least_radius;
    for (const double one : distance) trusted[r].push_back(trust(one, radius, input.outer_to_inner * radius));
  }
  const auto score = [&](double smoothing, double strength, std::size_t r, const Eigen::VectorXd& h) {
    Variant variant{smoothing, strength, kRadiusFactors[r] * input.least_radius,
                    std::vector<double>(static_cast<std::size_t>(input.folds), 0.0)};
    for (std::size_t i = 0; i < input.samples.size(); ++i) {
      if (!counts[i]) continue;
      const LeftOutSample& sample = input.samples[i];
      const double force_N = force_of(sample, input, strength, trusted[r][i], h(static_cast<Eigen::Index>(i)));
      variant.fold_squares[static_cast<std::size_t>(sample.fold)] +=
          saturated_square((force_N - sample.force_N) * inverse_jnd[i]);
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
    for (std::size_t r = 0; r < kRadiusFactors.size(); ++r) {
      for (const double strength : kStrengths) of_decade[at].push_back(score(smoothing, strength, r, predictions[at]));
    }
  });
  // "None" first, then from the most smoothing to the least.
  std::vector<Variant> variants{score(fits.unit(), 0.0, 0, nothing)};
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
    const double trust_here = trust(distance[i], chosen->inner_radius, input.outer_to_inner * chosen->inner_radius);
    const double force_N = force_of(sample, input, chosen->strength, trust_here, h(static_cast<Eigen::Index>(i)));
    choice.predictions.push_back({i, std::abs(force_N - sample.force_N), force_N, distance[i]});
    const double trend_N = force_of(sample, input, 0.0, 0.0, 0.0);
    choice.trend_predictions.push_back({i, std::abs(trend_N - sample.force_N), trend_N, distance[i]});
  }
  return choice;
}

}  // namespace palpate
