#include "models/solve/solve_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "models/solve/lapack.h"
#include "models/solve/penalised_weights.h"
#include "models/solve/row_folder.h"

namespace palpate {
namespace {

// With 100 centres 84 MB.
constexpr Eigen::Index kMostKeptSites = 100000;

// The ridge of the largest evidence, see solve_weights.h. `s`: the singular
// values that count, descending; `z`: the data's shares along them; `rest`: the
// squared length of what lies outside; `rows`: how many there are.
double ridge_by_evidence(const Eigen::ArrayXd& s, const Eigen::ArrayXd& z, double rest, double rows) {
  constexpr int kStepsPerDecade = 4;
  constexpr int kLowestDecade = -24;  // of the square: the truncation
  // From a handful of rows, or hardly more than unknowns, a force cannot be told
  // from noise; then the large directions, which carry the mean, stay as they are.
  const int highest_decade = rows < 20.0 + 2.0 * static_cast<double>(s.size()) ? -5 : 0;
  if (s.size() == 0 || !(z.square().sum() > 0.0)) return 0.0;
  double best = 0.0;
  double lowest = std::numeric_limits<double>::infinity();
  for (int step = kLowestDecade * kStepsPerDecade; step <= highest_decade * kStepsPerDecade; ++step) {
    const double lambda = s[0] * s[0] * std::pow(10.0, static_cast<double>(step) / kStepsPerDecade);
    const Eigen::ArrayXd left = lambda / (s.square() + lambda);
    const double cost = rows * std::log((left * z.square()).sum() + rest) - left.log().sum();
    if (cost < lowest) {
      lowest = cost;
      best = lambda;
    }
  }
  return best;
}

// Whether the sites tell the unknowns apart by themselves: many of them, and a ridge
// of next to nothing is the most probable. Then least squares stays as it is, for the
// ridge would only take from the force at first touch, where few sites lie. On
// recordings, virtual and real, 1e-7 of the square of the largest singular value and
// less was seen; with noise that hides the force, 1.
bool sites_decide(double lambda, double largest, double rows, double unknowns) {
  constexpr double kNoiseRules = 1e-6;
  constexpr double kRowsEach = 10.0;
  return rows >= kRowsEach * unknowns && lambda < kNoiseRules * largest * largest;
}

// False when the iteration did not converge. `triangle`: [R z; 0 rho].
bool scale_triangle(const Eigen::MatrixXd& triangle, ScaledTriangle& scaled) {
  const Eigen::Index n = triangle.cols() - 1;
  Eigen::MatrixXd r = triangle.topLeftCorner(n, n);
  Eigen::VectorXd& scale = scaled.scale;
  scale = r.colwise().stableNorm().transpose();
  // A column of next to nothing (the kernel of a centre on top of every site)
  // is not scaled up: it would need a weight of 1e20 to matter.
  scale = (scale.array() > 1e-20 * scale.maxCoeff()).select(scale, std::max(scale.maxCoeff(), 1e-300));
  r.array().rowwise() /= scale.transpose().array();
  return svd(std::move(r), scaled.parts);
}

struct SmallSolution {
  Eigen::VectorXd unknowns;
  double ridge = 0.0;  // of the square of the largest singular value
  double residual_squared = 0.0;
  Eigen::Index rank = 0;
  double condition = 0.0;
};

// The triangle is [R z; 0 rho]: minimises |R x - z|^2 + rho^2, and the ridge. `scaled`: of R.
SmallSolution solve_triangle(const Eigen::MatrixXd& triangle, const ScaledTriangle& scaled, double truncation,
                             Ridge ridge, double rows) {
  const Eigen::Index n = triangle.cols() - 1;
  const Svd& parts = scaled.parts;
  SmallSolution out;
  const double smallest = truncation * parts.s[0];
  out.rank = (parts.s.array() > smallest && parts.s.array() > 0.0).count();
  Eigen::VectorXd z = parts.u.transpose() * triangle.col(n).head(n);
  const double rho = triangle(n, n);
  const double rest = rho * rho + z.tail(n - out.rank).squaredNorm();
  const Eigen::ArrayXd kept = parts.s.head(out.rank);
  double lambda = ridge == Ridge::by_evidence ? ridge_by_evidence(kept, z.head(out.rank), rest, rows) : 0.0;
  if (lambda > 0.0 && sites_decide(lambda, kept[0], rows, static_cast<double>(n))) lambda = 0.0;
  out.ridge = lambda > 0.0 ? lambda / (kept[0] * kept[0]) : 0.0;
  const Eigen::ArrayXd left = lambda / (kept.square() + lambda);
  out.residual_squared = rest + (left * z.head(out.rank).array()).square().sum();
  z.head(out.rank).array() *= kept / (kept.square() + lambda);
  out.unknowns = parts.vt.topRows(out.rank).transpose() * z.head(out.rank);
  out.unknowns.array() /= scaled.scale.array();
  out.condition = parts.s[n - 1] > 0.0 ? parts.s[0] / parts.s[n - 1] : 1e300;
  return out;
}

// What a solution of the triangle says of the sites it came from.
FittedRbf fitted_from(const SmallSolution& solution, const FoldedRows& folded, KernelKind kernel,
                      const Eigen::MatrixXd& centres, Ridge ridge) {
  FittedRbf fitted;
  fitted.function = {kernel, centres, solution.unknowns.head(centres.cols()),
                     solution.unknowns.tail(solution.unknowns.size() - centres.cols())};
  if (ridge == Ridge::by_evidence) {
    fitted.function.weights *= folded.strength;
    fitted.function.tail *= folded.strength;
  }
  FitReport& report = fitted.report;
  report.centres_asked = report.centres_used = centres.cols();
  report.columns = solution.unknowns.size();
  report.rank = solution.rank;
  report.condition = solution.condition;
  report.smoothing = solution.ridge;
  report.residual_rms = std::sqrt(solution.residual_squared / static_cast<double>(folded.sites));
  if (report.rank < report.columns)
    report.notes.push_back("the data determine " + std::to_string(report.rank) + " of " +
                           std::to_string(report.columns) + " unknowns; the rest took the shortest solution");
  return fitted;
}

Error not_converged() {
  return Error{"the singular value decomposition did not converge; check the recording for extreme values"};
}

// Without the triangle.
FoldedRows counted(const Sites& sites) {
  FoldedRows folded;
  folded.sites = sites.count();
  folded.rows = (sites.row_scale.array() > 0.0).count();
  folded.smoothing = sites.smoothing;
  folded.strength = sites.strength;
  return folded;
}

}  // namespace

bool fold_rows(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres, const FitControl& control,
               FoldedRows& folded) {
  folded = counted(sites);
  return RowFolder(sites, kernel, centres).fold(control, false, folded.triangle);
}

Status validate_centres(const Sites& sites, const Eigen::MatrixXd& centres) {
  if (const Status status = validate_sites(sites); !status) return status;
  if (centres.rows() == sites.points.rows() && centres.allFinite()) return {};
  return Error{"centres have " + std::to_string(centres.rows()) + " coordinates or are not finite, expected " +
               std::to_string(sites.points.rows()) + " finite ones, as the sites have"};
}

Result<FittedRbf> solve_folded(const FoldedRows& folded, KernelKind kernel, const Eigen::MatrixXd& centres, Ridge ridge,
                               double truncation) {
  if (ridge == Ridge::by_evidence && folded.smoothing && kernel == KernelKind::cubic) {
    return penalised_weights(folded, kernel, centres);
  }
  const BlasThreads one_thread(1);
  ScaledTriangle scaled;
  if (!scale_triangle(folded.triangle, scaled)) return not_converged();
  const SmallSolution solution =
      solve_triangle(folded.triangle, scaled, truncation, ridge, static_cast<double>(folded.rows));
  return fitted_from(solution, folded, kernel, centres, ridge);
}

Result<FittedRbf> solve_weights(const Sites& sites, KernelKind kernel, const Eigen::MatrixXd& centres,
                                const FitControl& control, Ridge ridge, double truncation) {
  if (const Status status = validate_centres(sites, centres); !status) return status.error();
  if (!control.may_continue(0.0)) return interrupted();
  const BlasThreads one_thread(1);
  FoldedRows folded;
  if (!fold_rows(sites, kernel, centres, control, folded)) return interrupted();
  auto fitted = solve_folded(folded, kernel, centres, ridge, truncation);
  if (!control.may_continue(1.0)) return interrupted();
  return fitted;
}

Result<FittedRbf> solve_largest(const Sites& sites, KernelKind kernel, const CentreSequence& sequence,
                                Eigen::Index asked, const FitControl& control) {
  auto fitted = solve_weights(sites, kernel, sequence.centres_of(sequence.most), control, Ridge::by_evidence);
  if (!fitted) return fitted;
  fitted->report.centres_asked = asked;
  if (!sequence.shortage.empty()) {
    fitted->report.notes.push_back("only " + std::to_string(sequence.most) + " centres: " + sequence.shortage);
  }
  return fitted;
}

struct RepeatedSolve::Factors {
  RowFolder folder;
  ScaledTriangle scaled;
};

RepeatedSolve::RepeatedSolve(const Sites& sites, KernelKind kernel, Eigen::MatrixXd centres)
    : sites_(sites), kernel_(kernel), centres_(std::move(centres)) {}

RepeatedSolve::~RepeatedSolve() = default;

Result<FittedRbf> RepeatedSolve::solve() {
  const BlasThreads one_thread(1);
  FoldedRows folded = counted(sites_);
  const bool keeps = sites_.count() <= kMostKeptSites;
  if (factors_ != nullptr && keeps) {
    factors_->folder.fold_again(folded.triangle);
  } else {
    if (const Status status = validate_centres(sites_, centres_); !status) return status.error();
    auto factors = std::make_unique<Factors>(Factors{RowFolder(sites_, kernel_, centres_), {}});
    factors->folder.fold({}, keeps, folded.triangle);
    if (!scale_triangle(folded.triangle, factors->scaled)) return not_converged();
    factors_ = std::move(factors);
  }
  const SmallSolution solution = solve_triangle(folded.triangle, factors_->scaled, kDefaultTruncation,
                                                Ridge::by_evidence, static_cast<double>(folded.rows));
  return fitted_from(solution, folded, kernel_, centres_, Ridge::by_evidence);
}

}  // namespace palpate
