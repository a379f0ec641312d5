#include "models/fit/nested_fit.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "models/linear/lapack.h"

namespace palpate {

Result<NestedWeights> NestedWeights::factorise(const Sites& sites, KernelKind kernel, CentreSequence sequence) {
  auto factorised = factorise_rows(sites, kernel, sequence.pool);
  if (!factorised) return factorised.error();
  return NestedWeights(kernel, std::move(sequence), std::move(*factorised));
}

// The triangle of the tail, these kernel columns and the data.
FactorisedRows NestedWeights::factorised_for(const std::vector<Eigen::Index>& columns) const {
  const Eigen::MatrixXd& all = factorised_.triangle;
  const Eigen::Index last = all.cols() - 1;
  const Eigen::Index tail = last - sequence_.pool.cols();
  std::vector<Eigen::Index> kept(static_cast<std::size_t>(tail));
  std::iota(kept.begin(), kept.end(), Eigen::Index{0});
  for (const Eigen::Index column : columns) kept.push_back(tail + column);
  const Eigen::Index rows = kept.empty() ? 0 : *std::max_element(kept.begin(), kept.end()) + 1;
  kept.push_back(last);
  FactorisedRows factorised = factorised_;
  Eigen::MatrixXd& triangle = factorised.triangle;
  triangle = Eigen::MatrixXd::Zero(rows + 1, static_cast<Eigen::Index>(kept.size()));
  triangle.topRows(rows) = all(Eigen::seqN(0, rows), kept);
  // The norm of the data outside of the span of these columns.
  triangle(rows, triangle.cols() - 1) = all.col(last).tail(last + 1 - rows).norm();
  if (triangle.rows() > triangle.cols()) {
    qr_in_place(triangle);
    triangle = triangle.topRows(triangle.cols()).triangularView<Eigen::Upper>().toDenseMatrix();
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
    const Sites sites = sites_without(*prepared.left_out, fold, prepared.sites);
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
