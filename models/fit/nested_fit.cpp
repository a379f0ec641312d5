#include "models/fit/nested_fit.h"

#include <algorithm>
#include <string>

#include "models/fit/bound_calibration.h"
#include "models/linear/lapack.h"

namespace palpate {

NestedWeights::NestedWeights(KernelKind kernel, CentreSequence sequence, FactorisedRows factorised)
    : kernel_(kernel), sequence_(std::move(sequence)), factorised_(std::move(factorised)) {
  const Eigen::MatrixXd& as_factorised = factorised_.triangle;
  const Eigen::Index n = sequence_.pool.cols();
  const Eigen::Index tail = as_factorised.cols() - 1 - n;
  Eigen::MatrixXd reordered(as_factorised.rows(), as_factorised.cols());
  reordered << as_factorised.middleCols(n, tail), as_factorised.leftCols(n), as_factorised.rightCols(1);
  const BlasThreads one_thread(1);
  qr_in_place(reordered);
  factorised_.triangle = reordered.triangularView<Eigen::Upper>();
}

Result<NestedWeights> NestedWeights::factorise(const Sites& sites, KernelKind kernel, CentreSequence sequence) {
  auto factorised = factorise_rows(sites, kernel, sequence.pool);
  if (!factorised) return factorised.error();
  return NestedWeights(kernel, std::move(sequence), std::move(*factorised));
}

// The triangle of these columns, in the order of solve_weights: Phi, G, f.
FactorisedRows NestedWeights::factorised_for(const std::vector<Eigen::Index>& columns) const {
  const Eigen::MatrixXd& all = factorised_.triangle;
  const Eigen::Index last = all.cols() - 1;
  const Eigen::Index tail = last - sequence_.pool.cols();
  const auto k = static_cast<Eigen::Index>(columns.size());
  const Eigen::Index newest = k > 0 ? *std::max_element(columns.begin(), columns.end()) + 1 : 0;
  const Eigen::Index rows = tail + newest;
  FactorisedRows factorised = factorised_;
  factorised.triangle = Eigen::MatrixXd::Zero(rows + 1, k + tail + 1);
  for (Eigen::Index j = 0; j < k; ++j) {
    factorised.triangle.col(j).head(rows) = all.col(tail + columns[static_cast<std::size_t>(j)]).head(rows);
  }
  factorised.triangle.block(0, k, rows, tail) = all.topLeftCorner(rows, tail);
  factorised.triangle.col(k + tail).head(rows) = all.col(last).head(rows);
  // The norm of the data outside of the span of these columns.
  factorised.triangle(rows, k + tail) = all.col(last).tail(last + 1 - rows).norm();
  if (factorised.triangle.rows() > factorised.triangle.cols()) {
    qr_in_place(factorised.triangle);
    factorised.triangle = factorised.triangle.topRows(k + tail + 1).triangularView<Eigen::Upper>().toDenseMatrix();
  }
  return factorised;
}

FittedRbf NestedWeights::solve(Eigen::Index count) const {
  const BlasThreads one_thread(1);
  const std::vector<Eigen::Index> columns = sequence_.columns_of(std::clamp<Eigen::Index>(count, 0, most()));
  return penalised_weights(factorised_for(columns), kernel_, sequence_.pool(Eigen::all, columns));
}

Result<NestedFit> NestedFit::make(const PreparedTraining& prepared, const MethodRequest& request,
                                  const FitControl& control) {
  if (request.method->choose == nullptr) {
    return Error{std::string("the method \"") + request.method->name + "\" cannot continue from fewer centres"};
  }
  const auto factorised = [&](const Sites& sites, const Eigen::VectorXd& jnd_N) -> Result<NestedWeights> {
    if (const Status status = validate_sites(sites); !status) return status.error();
    auto sequence = request.method->choose({sites, jnd_N, request}, control);
    if (!sequence) return sequence.error();
    return NestedWeights::factorise(sites, request.kernel, std::move(*sequence));
  };
  auto weights = factorised(prepared.sites, site_thresholds(prepared));
  if (!weights) return weights.error();
  NestedFit made(prepared, request, std::move(*weights));
  for (int fold = 0; prepared.left_out && fold < prepared.left_out->folds(); ++fold) {
    const Sites sites = sites_without(prepared, fold);
    made.without_fold_.emplace_back();
    if (sites.count() == 0) continue;
    auto without = factorised(sites, sites.row_scale.cwiseInverse());
    if (!without) return without.error();
    made.without_fold_.back().emplace(std::move(*without));
  }
  return made;
}

Result<MethodFit> NestedFit::fit(Eigen::Index count) const {
  std::vector<CorrectionPtr> of_folds;
  for (const std::optional<NestedWeights>& one : without_fold_) {
    of_folds.push_back(one ? rbf_correction(one->solve(count), "").correction : nullptr);
  }
  FittedRbf fitted = weights_.solve(count);
  const std::string size = std::to_string(fitted.report.centres_used);
  return model_of(*prepared_, request_, rbf_correction(std::move(fitted), size), of_folds);
}

}  // namespace palpate
