// The lowest rung of the ladder: a model that always says 0 N. What it has within
// the JND is given away by the threshold, not earned by a model.
// Thread guarantee: as ForceModel.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/tick/force_model.h"

namespace palpate {

class NoForce final : public ForceModel {
 public:
  explicit NoForce(std::vector<FeatureSpec> features) : features_(std::move(features)) {}

  ForceEstimate evaluate(const double*) const noexcept override { return {}; }
  const std::vector<FeatureSpec>& features() const noexcept override { return features_; }
  const std::string& name() const noexcept override { return name_; }
  const std::string& method() const noexcept override { return name_; }
  int centre_count() const noexcept override { return 0; }

 private:
  std::vector<FeatureSpec> features_;
  std::string name_ = "no-force";
};

}  // namespace palpate
