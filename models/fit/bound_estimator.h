// Fits the error bound of a model (models/model/fitted_model.h) to cross-validated errors.
//
// The non-negative coefficients are fitted to the absolute errors by least squares, with rows scaled by 1 / JND. Then
// all are multiplied by the quantile of error over bound that gives a coverage of 97.5 % of the rows: more than 95 %,
// because a new recording differs more from the training than its strokes from each other. The floor is at least 10 mN
// (kForceFloor_N): without this minimum the coverage was 77 to 90 % on skin and 83 % on one trial of silicone, with it
// 97 to 100 %. The bound grows by a quarter of the largest force to the whole per unit of normalised distance. With
// fewer than three strokes it is at least 5 % of the force. Thread guarantee: slow side; one thread per object.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "models/fit/residual_rows.h"
#include "models/samples/cross_validation.h"

namespace palpate {

class BoundEstimator {
 public:
  BoundEstimator(const JndLine& jnd, double largest_force_N, std::size_t strokes)
      : jnd_(jnd), largest_force_N_(largest_force_N), strokes_(strokes) {}

  // Adds the prediction of one row by a model that was fitted without its fold. `beyond`: its distance to the nearest
  // row of another fold, beyond the inner radius.
  void add(double error_N, double predicted_N, double beyond) { rows_.push_back({error_N, predicted_N, beyond}); }
  // Adds all rows. `corrections`: fitted to the sites without each fold; empty: none, the errors are those of the
  // trend. Returns the errors by fold.
  FoldErrors add(const ResidualRows& rows, const ModelData& common, const std::vector<CorrectionPtr>& corrections);

  // Empty with fewer than 50 predictions.
  std::optional<ErrorBound> fit() const;

 private:
  struct Row {
    double error_N = 0.0;
    double predicted_N = 0.0;
    double beyond = 0.0;
  };
  JndLine jnd_;
  double largest_force_N_;
  std::size_t strokes_;
  std::vector<Row> rows_;
};

}  // namespace palpate
