// The rows that the correction and the error bound are fitted to: samples in contact, each with the trend that was
// fitted without its fold (models/samples/cross_validation.h).
// Thread guarantee: value types and pure functions, slow side.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "models/correction/sites.h"
#include "models/model/fitted_model.h"
#include "models/trend/trend_estimator.h"

namespace palpate {

// In ascending order of their folds.
struct ResidualRows {
  Eigen::MatrixXd points;   // normalised features, one column a row
  Eigen::VectorXd force_N;  // measured
  Eigen::VectorXd depth_m;
  Eigen::VectorXd row_scale;  // factor of the residual
  Eigen::MatrixXd trend_N;    // rows x folds: column k by the trend fitted without fold k
  std::vector<int> fold;
  std::vector<char> no_force;    // no measured force: the force is not positive
  std::vector<double> distance;  // to the nearest row of another fold; infinite if there is none
  std::size_t strokes = 0;       // of all recordings
  KernelKind kernel = KernelKind::cubic;

  int folds() const { return static_cast<int>(trend_N.cols()); }
  // The residual of the trend without that fold. Where no force is measured, a trend below 0 needs no correction.
  Eigen::VectorXd residual_N(int without) const;
  // The force at row `i` from the other folds, as FittedModel computes it but without the upper limit, with this inner
  // radius of the trust. `h`: the correction, N.
  double predicted_N(const ModelData& common, std::size_t i, double inner_radius, double h) const;
  // The sites of a fit without a fold, at most 1500. The targets are the residuals of the trend without that fold.
  Sites sites_without(int without, double smoothing) const;
  // Sets `distance`.
  void find_distances();

 private:
  // The indices of the rows of the other folds.
  std::vector<Eigen::Index> outside(int without) const;
};

// Rows of the regression of the trend, at most 2500 of them. `common`: with the normalisation. `features`: at the
// samples in contact, SI. `left_out_trends`: columns x folds, the weights of the trends fitted without each fold.
ResidualRows residual_rows(const ModelData& common, const TrendColumns& columns, const TrendWeights& weights,
                           const Eigen::MatrixXd& features, const Eigen::MatrixXd& left_out_trends);

}  // namespace palpate
