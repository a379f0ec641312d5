// A radial basis function as the correction of a model: the data for files and fits, and the evaluator for the tick.
// Thread guarantee: immutable.
#pragma once

#include "models/model/correction.h"
#include "models/model/rbf/rbf_evaluate.h"
#include "models/model/rbf/rbf_function.h"

namespace palpate {

class RbfCorrection final : public Correction {
 public:
  explicit RbfCorrection(RbfFunction function);

  double evaluate(const double* u) const noexcept override { return evaluator_.evaluate(u); }
  int size() const noexcept override { return static_cast<int>(function_.centre_count()); }
  // kernel, tail, centres and weights; centres and weights one to a line.
  FileFields file_fields() const override;

  const RbfFunction& function() const noexcept { return function_; }

 private:
  RbfFunction function_;
  RbfEvaluator evaluator_;
};

// The function of a correction of this kind, else null.
const RbfFunction* rbf_of(const CorrectionPtr& correction);

}  // namespace palpate
