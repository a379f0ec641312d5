// The interface of a force model to the tick: a feature vector in, a force out.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "engine/tick/features.h"

namespace palpate {

struct ForceEstimate {
  double force_N = 0.0;
  // The feature vector is outside the domain of the training data, where the force is mainly that of the trend
  // (models/model/domain_guard.h).
  bool out_of_domain = false;
  // 95 % bound on the error of the force, N; NaN if the model has none (models/model/fitted_model.h).
  double predicted_error_N = std::numeric_limits<double>::quiet_NaN();
};

// Immutable.
// Thread guarantee: `evaluate` may run on any thread, also on several at once; it is wait-free, allocates nothing and
// never throws.
class ForceModel {
 public:
  virtual ~ForceModel() = default;

  // `features`: the values of `features()` in contact, SI units, finite. Returns a force of at most 1.2 x the largest
  // training force, negative only for a material that pulls, at most as strongly as it did in the training.
  virtual ForceEstimate evaluate(const double* features) const noexcept = 0;

  virtual const std::vector<FeatureSpec>& features() const noexcept = 0;
  // The greatest depth that enters the memory of the features, m: that of the training domain.
  virtual double deepest_m() const noexcept { return std::numeric_limits<double>::infinity(); }
  // At a smaller depth, and in air, the model is out of its domain, m: above 0 if the training never left the material.
  virtual double shallowest_m() const noexcept { return 0.0; }
  virtual const std::string& name() const noexcept = 0;    // e.g. "greedy-100"
  virtual const std::string& method() const noexcept = 0;  // e.g. "greedy"
  virtual int centre_count() const noexcept = 0;           // nodes for a grid
};

using ForceModels = std::vector<std::shared_ptr<const ForceModel>>;

}  // namespace palpate
