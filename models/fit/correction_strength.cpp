#include "models/fit/correction_strength.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/base/parallel.h"
#include "engine/base/random_stream.h"
#include "models/linear/lapack.h"
#include "models/model/domain_guard.h"
#include "models/model/rbf/polynomial_tail.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/solve/penalised_weights.h"
#include "models/training/selection.h"
#include "models/training/weighting.h"

namespace palpate {
namespace {

constexpr Eigen::Index kCentres = 200;
constexpr Eigen::Index kBlockRows = 512;  // of the design at a time
constexpr int kLowestDecade = -9;         // of the smoothing, relative to the mean eigenvalue
constexpr int kHighestDecade = 1;
constexpr std::array kStrengths{1.0, 0.75, 0.5, 0.25};
constexpr std::array kRadiusFactors{1.0, 2.0, 4.0, 8.0};

// The fits without each fold, for any smoothing. The rows are sorted by fold.
class LeftOutFits {
 public:
  explicit LeftOutFits(const StrengthInput& input)
      : input_(input),
        centres_(random_centres(input.rows.points)),
        space_(penalty_space(input.kernel, centres_)),
        columns_(space_.free + tail_size(tail_degree(input.kernel), static_cast<int>(input.rows.points.rows()))),
        unit_(mean_eigenvalue()),
        design_(input.rows.points.cols(), columns_),
        folds_(static_cast<std::size_t>(input.folds)) {
    const auto blocks = static_cast<int>((design_.rows() + kBlockRows - 1) / kBlockRows);
    parallel_for(blocks, [&](int block) { fill_design(block); });
    parallel_for(input_.folds, [&](int fold) { gather(fold); });
    Eigen::MatrixXd total = Eigen::MatrixXd::Zero(columns_, columns_);
    for (const Fold& fold : folds_) total += fold.gram;
    for (Fold& fold : folds_) fold.gram = total - fold.gram;
  }

  double unit() const { return unit_; }

  // Predicts the correction at every row from the rows of the other folds.
  Eigen::VectorXd predictions(double smoothing) const {
    Eigen::VectorXd values(design_.rows());
    for (const Fold& fold : folds_) {
      if (fold.count == 0) continue;
      const Eigen::VectorXd coefficients = solve(fold.gram, smoothing, fold.right);
      Eigen::VectorXd of_fold(fold.count);
      multiply(design_.middleRows(fold.first, fold.count), false, coefficients, false, 1.0, 0.0, of_fold);
      values.segment(fold.first, fold.count) = of_fold;
    }
    return values;
  }

 private:
  struct Fold {
    Eigen::Index first = 0;
    Eigen::Index count = 0;
    Eigen::MatrixXd gram;   // first of its own rows, then of all others; the lower triangle
    Eigen::VectorXd right;  // of all others, for the residual of the trend without this fold
  };

  static Eigen::MatrixXd random_centres(const Eigen::MatrixXd& points) {
    const Eigen::Index count = std::clamp<Eigen::Index>(points.cols() / 4, 1, kCentres);
    Eigen::MatrixXd centres(points.rows(), count);
    std::vector<Eigen::Index> order(static_cast<std::size_t>(points.cols()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    SplitMix64 random(1);
    for (Eigen::Index j = 0; j < count; ++j) {
      const auto left = static_cast<std::uint64_t>(points.cols() - j);
      std::swap(order[static_cast<std::size_t>(j)],
                order[static_cast<std::size_t>(j) + static_cast<std::size_t>(random.below(left))]);
      centres.col(j) = points.col(order[static_cast<std::size_t>(j)]);
    }
    return centres;
  }

  // The mean eigenvalue of the kernel between all scaled rows, estimated at the centres: the unit of the smoothing.
  double mean_eigenvalue() const {
    const double trace = space_.penalty.trace();
    const double rows = std::max(1.0, static_cast<double>(centres_.cols()));
    const double mean_scale = input_.rows.row_scale.squaredNorm() / static_cast<double>(input_.rows.row_scale.size());
    const double value = trace / rows * mean_scale;
    return value > 0.0 ? value : 1.0;
  }

  // Fills a block of rows of [K Z, G].
  void fill_design(int block) {
    const Eigen::Index first = block * kBlockRows;
    const Eigen::Index rows = std::min(kBlockRows, design_.rows() - first);
    const Eigen::MatrixXd some = input_.rows.points.middleCols(first, rows);
    Eigen::MatrixXd kernel(rows, centres_.cols());
    kernel_matrix(input_.kernel, PointArrays(some), centres_, kernel);
    multiply_by_basis(kernel, space_);
    design_.block(first, 0, rows, space_.free) = kernel.leftCols(space_.free);
    design_.block(first, space_.free, rows, columns_ - space_.free) = tail_matrix(tail_degree(input_.kernel), some);
  }

  void gather(int fold) {
    Fold& mine = folds_[static_cast<std::size_t>(fold)];
    const auto& of = input_.rows.fold;
    const auto [from, to] = std::equal_range(of.begin(), of.end(), fold);
    mine.first = from - of.begin();
    mine.count = to - from;
    mine.gram = Eigen::MatrixXd::Zero(columns_, columns_);
    mine.right = Eigen::VectorXd::Zero(columns_);
    if (mine.count > 0) {
      Eigen::MatrixXd part = design_.middleRows(mine.first, mine.count);
      part.array().colwise() *= input_.rows.row_scale.segment(mine.first, mine.count).array();
      gram(part, mine.gram);
    }
    Eigen::VectorXd left = input_.rows.force_N - input_.rows.trend_N.col(fold);
    for (Eigen::Index i = 0; i < left.size(); ++i) {
      // Where no force is measured, a trend below 0 needs no correction.
      if (input_.rows.no_force[static_cast<std::size_t>(i)] && left(i) > 0.0) left(i) = 0.0;
    }
    left.array() *= input_.rows.row_scale.array().square();
    left.segment(mine.first, mine.count).setZero();
    multiply(design_, true, left, false, 1.0, 0.0, mine.right);
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
  Eigen::MatrixXd centres_;
  PenaltySpace space_;
  Eigen::Index columns_;
  double unit_;
  Eigen::MatrixXd design_;  // [K Z, G]
  std::vector<Fold> folds_;
};

// Marks the rows that count: those not deeper than all rows of the other folds.
std::vector<char> inside_depth(const StrengthInput& input) {
  const CrossValidationRows& rows = input.rows;
  std::vector<double> deepest_m(static_cast<std::size_t>(input.folds), 0.0);
  for (std::size_t i = 0; i < rows.fold.size(); ++i) {
    double& deepest = deepest_m[static_cast<std::size_t>(rows.fold[i])];
    deepest = std::max(deepest, rows.depth_m(static_cast<Eigen::Index>(i)));
  }
  std::vector<char> counts;
  for (std::size_t i = 0; i < rows.fold.size(); ++i) {
    double elsewhere_m = 0.0;
    for (std::size_t k = 0; k < deepest_m.size(); ++k) {
      if (static_cast<int>(k) != rows.fold[i]) elsewhere_m = std::max(elsewhere_m, deepest_m[k]);
    }
    counts.push_back(rows.depth_m(static_cast<Eigen::Index>(i)) <= elsewhere_m ? 1 : 0);
  }
  return counts;
}

struct Variant {
  double smoothing = 0.0;
  double strength = 0.0;
  double inner_radius = 0.0;
  FoldErrors errors;
  const Eigen::VectorXd* correction_N = nullptr;
};

std::vector<FoldErrors> errors_of(const std::vector<Variant>& variants) {
  std::vector<FoldErrors> errors;
  for (const Variant& variant : variants) errors.push_back(variant.errors);
  return errors;
}

}  // namespace

double cross_validated_force_N(const StrengthInput& input, std::size_t i, double trust, double h) {
  const double limit = input.correction_limit_N;
  const auto row = static_cast<Eigen::Index>(i);
  const double force_N = input.rows.trend_N(row, input.rows.fold[i]) + trust * std::clamp(h, -limit, limit);
  return std::max(input.lowest_force_N, force_N);
}

double trust_at_distance(double distance, double inner_radius, double outer_radius) {
  if (!(distance < outer_radius)) return 0.0;
  if (distance <= inner_radius) return 1.0;
  const double t = (outer_radius - distance) / (outer_radius - inner_radius);
  return t * t * (3.0 - 2.0 * t);
}

void find_distances(CrossValidationRows& rows, int folds) {
  rows.distance.assign(rows.fold.size(), std::numeric_limits<double>::infinity());
  parallel_for(folds, [&](int fold) {
    std::vector<Eigen::Index> others;
    for (std::size_t i = 0; i < rows.fold.size(); ++i) {
      if (rows.fold[i] != fold) others.push_back(static_cast<Eigen::Index>(i));
    }
    if (others.empty()) return;
    const NearestDistance nearest(rows.points(Eigen::all, others));
    for (std::size_t i = 0; i < rows.fold.size(); ++i) {
      if (rows.fold[i] != fold) continue;
      const Eigen::VectorXd point = rows.points.col(static_cast<Eigen::Index>(i));
      rows.distance[i] = std::sqrt(nearest.nearest_squared(point.data()));
    }
  });
}

StrengthChoice choose_strength(const StrengthInput& input) {
  StrengthChoice choice;
  choice.inner_radius = input.least_radius;
  choice.strength = 0.0;
  const CrossValidationRows& rows = input.rows;
  if (rows.fold.size() < 2 || input.folds < 2) return choice;
  const BlasThreads one_thread(1);
  const LeftOutFits fits(input);
  const std::vector<char> counts = inside_depth(input);
  const auto score = [&](double smoothing, double strength, double radius, const Eigen::VectorXd& h) {
    Variant variant{smoothing, strength, radius, FoldErrors(static_cast<std::size_t>(input.folds)), &h};
    for (std::size_t i = 0; i < rows.fold.size(); ++i) {
      if (!counts[i]) continue;
      const auto row = static_cast<Eigen::Index>(i);
      const double trust =
          strength > 0.0 ? trust_at_distance(rows.distance[i], radius, input.outer_to_inner * radius) : 0.0;
      const double force_N = cross_validated_force_N(input, i, trust, strength * h(row));
      const double error = input.jnd.error_over_jnd(force_N, rows.force_N(row));
      variant.errors.add(static_cast<std::size_t>(rows.fold[i]), error * robust_scale(error));
    }
    return variant;
  };
  const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(rows.force_N.size());
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
  const Variant none = score(fits.unit(), 0.0, input.least_radius, nothing);
  std::vector<Variant> variants{none};
  for (const auto& some : of_decade) variants.insert(variants.end(), some.begin(), some.end());
  const double strength = variants[best_score(errors_of(variants))].strength;
  // From the simplest to the most complex: no correction, then by growing reach and, with the same reach, by falling
  // smoothing. (Similar strokes do not identify the reach.)
  std::erase_if(variants, [&](const Variant& one) { return one.strength != 0.0 && one.strength != strength; });
  std::stable_sort(variants.begin() + 1, variants.end(),
                   [](const Variant& a, const Variant& b) { return a.inner_radius < b.inner_radius; });
  const Variant* chosen = &variants[simplest_adequate(errors_of(variants))];
  choice.smoothing = chosen->smoothing;
  choice.strength = chosen->strength;
  choice.inner_radius = chosen->inner_radius;
  choice.trend_error_over_jnd = none.errors.rms_at_mean_score();
  choice.error_over_jnd = chosen->errors.rms_at_mean_score();
  return choice;
}

}  // namespace palpate
