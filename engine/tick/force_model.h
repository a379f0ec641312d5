// What every force model is to the tick: a feature vector in, a force out.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "engine/tick/features.h"

namespace palpate {

struct ForceEstimate {
  double force_N = 0.0;
  // The feature vector is not near the data that the model was fitted to: the
  // force comes from the model's safe trend, see models/model/domain_guard.h.
  bool out_of_domain = false;
  // The force is off by at most this in 95 of 100 samples; NaN where the model does
  // not know (models/model/error_bound.h).
  double predicted_error_N = std::numeric_limits<double>::quiet_NaN();
};

// Immutable once built. Thread guarantee: `evaluate` may run on any thread, also
// several at once; it is wait-free, allocates nothing and never throws.
class ForceModel {
 public:
  virtual ~ForceModel() = default;

  // `features`: as many values as `features()` names, SI units, finite. Returns a
  // force of at most 1.2 x the largest training force, below 0 only where the material pulled in
  // training, and never beyond its strongest pull; contact is assumed.
  virtual ForceEstimate evaluate(const double* features) const noexcept = 0;

  virtual const std::vector<FeatureSpec>& features() const noexcept = 0;
  virtual const std::string& name() const noexcept = 0;    // e.g. "greedy-100"
  virtual const std::string& method() const noexcept = 0;  // e.g. "greedy"
  virtual int centre_count() const noexcept = 0;           // nodes for a grid
};

}  // namespace palpate
