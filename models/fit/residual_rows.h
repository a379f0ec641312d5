// Rows of samples in contact, each with the trend that was fitted without its fold (models/samples/selection.h),
// and what is fitted to them: the choice of the correction and, to folds of whole units, the error bound. Thread
// guarantee: slow side, value types and pure functions.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/correction/sites.h"
#include "models/model/fitted_model.h"
#include "models/samples/selection.h"
#include "models/trend/trend_estimator.h"

namespace palpate {

// In ascending order of their folds.
struct ResidualRows {
  Eigen::MatrixXd points;   // normalised features, one column a row
  Eigen::VectorXd force_N;  // measured
  Eigen::VectorXd depth_m;
  Eigen::VectorXd row_scale;  // factor of the residual: 1 / JND
  Eigen::MatrixXd trend_N;    // rows x folds: column k by the trend fitted without fold k
  std::vector<int> fold;
  std::vector<char> no_force;    // no measured force: the force is not positive
  std::vector<double> distance;  // to the nearest row of another fold; infinite if there is none
  std::vector<int> unit;
  Eigen::VectorXd speed_m_per_s;
  // What is added to the error of a prediction where the recording is taken as recorded: the change of the elastic
  // response by the offset of its position, less its force zero; and the uncertainty of the offset, >= 0.
  Eigen::VectorXd moved_N, moved_error_N;
  KernelKind kernel = KernelKind::cubic;

  int folds() const { return static_cast<int>(trend_N.cols()); }
  // The residual of the trend without that fold. Where no force is measured, a trend below 0 needs no correction.
  Eigen::VectorXd residual_N(int without) const;
  // The force at row `i` from the other folds, as FittedModel computes it but without the upper limit, with this inner
  // radius of the trust. `h`: the correction, N.
  double predicted_N(const ModelData& common, std::size_t i, double inner_radius, double h) const;
  // The sites of a fit without a fold, at most 1000. The targets are the residuals of the trend without that fold.
  Sites sites_without(int without, double smoothing) const;
  // Sets `distance`.
  void find_distances();

 private:
  // The indices of the rows of the other folds.
  std::vector<Eigen::Index> outside(int without) const;
};

// Rows of the regression of the trend, at most 2500 of them. `common`: with the normalisation and the JND. `features`:
// at the samples in contact, SI. `left_out_trends`: columns x folds, the weights of the trends fitted without each
// fold.
ResidualRows residual_rows(const ModelData& common, const TrendColumns& columns, const Eigen::MatrixXd& features,
                           const Eigen::MatrixXd& left_out_trends);

// The prediction of a row, as recorded, by a model that was fitted without its fold. `beyond`: its distance to the
// nearest row of another fold, beyond the inner radius.
struct Prediction {
  double error_N = 0.0, predicted_N = 0.0, beyond = 0.0;
  int unit = 0;
  double depth_m = 0.0, speed_m_per_s = 0.0;
};
// Of all rows that have another fold, those of a unit in order of time. `corrections`: fitted to the sites without each
// fold; empty: none, the errors are those of the trend.
std::vector<Prediction> predictions_of(const ResidualRows& rows, const ModelData& common,
                                       const std::vector<CorrectionPtr>& corrections);
// Fits the error bound of a model (models/model/fitted_model.h): non-negative least squares with rows scaled by 1 /
// JND, then all coefficients times a quantile over units of the factor that each needs: the largest of the 95 %
// quantiles of its error over the bound among all its rows and the first, the deepest and the fastest tenth of them.
// Units, unlike rows, are exchangeable if the next recording is made like these, so that a new one needs at most this
// factor with a probability of 9 in 10 (Lei et al. 2018, section 2.2) or, with K < 9 of them, K / (K + 1). The floor is
// at least kForceFloor_N. `common`: with the JND and the largest force. None with fewer than 50 predictions or two
// units: one does not show how the next one differs.
std::optional<ErrorBound> fit_bound(const std::vector<Prediction>& predictions, const ModelData& common);

struct CorrectionChoice {
  bool used = false;
  double smoothing = 0.0, inner_radius = 0.0;
  double trend_error_over_jnd = 0.0;  // cross-validated (FoldErrors::rms_at_mean_score), without the correction
  double error_over_jnd = 0.0;        // the same, with the correction
};

// Selects by cross-validation whether a model has a correction, how smooth it is, and how far from the data it is
// trusted (models/METHOD.md, Correction; Wahba 1990; Craven & Wahba 1979). One smoothing serves every method: with more
// centres each approaches the smoothing spline. `common`: needs the JND, the limits of correction and force, and a
// cover with every site inside, whose inner radius is the smallest candidate.
CorrectionChoice choose_correction(const ResidualRows& rows, const ModelData& common);

}  // namespace palpate
