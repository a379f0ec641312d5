// A fitted force model: its data, and the ForceModel that evaluates them.
//   f(x) = clamp( T(x) + g(u) clamp(h(u), -limit, limit), lowest, largest ),   u = (x - offset) / scale
// T: the trend (models/model/trend.h). h: the correction (models/model/correction.h): eq. 2 of Hoever & Harders (2009),
// a grid of its values, or none. g: the trust (models/model/domain_guard.h). Out of its domain a model is thus the
// trend: continuous, bounded, and attracting the tool at most as much as the material did. A model of the measured
// force has T = 0 and g = 1 everywhere. Thread guarantee: FittedModel is immutable; evaluation as in ForceModel.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/tick/force_model.h"
#include "engine/tick/jnd.h"
#include "engine/tick/tool_sample.h"
#include "models/model/correction.h"
#include "models/model/domain_guard.h"
#include "models/model/trend.h"

namespace palpate {

// The offset of a training recording: of its positions from the surface of the model, and of its forces. 0: as
// recorded.
struct RecordingOffset {
  std::string name;
  double offset_m = 0.0;
  double standard_error_m = 0.0;  // infinite: not identified
  double force_zero_N = 0.0;
  std::uint64_t content_hash = 0;  // of its rows as recorded; not stored in files
};

// The origin of a model; it has no effect on the forces.
struct Provenance {
  std::vector<std::string> recordings;
  std::vector<RecordingOffset> offsets;
  std::string scene;
  std::uint64_t samples = 0;  // rows of all recordings
  std::uint64_t contact_samples = 0, samples_after_reduction = 0, seed = 0;
  std::string weighting;   // jnd, relative, none
  std::string thinning;    // coverage, force, none
  std::string relaxation;  // scene, auto, given
  double training_within_jnd = 0.0;
};

// The bound on the error of a model's force where no force is measured, at 95 %:
//   bound(x) = floor + per_force |f(x)| + per_distance max(0, distance(x) - inner radius) >= |model - material|
// distance: to the nearest training data in the normalised feature space (domain_guard.h). The coefficients are fitted
// to errors of whole recordings or presses that were left out, and scaled by a quantile over these
// (models/fit/residual_rows.h). Sources: Vovk (2015), "Cross-conformal predictors"; Lei, G'Sell, Rinaldo, Tibshirani &
// Wasserman (2018), section 5.2 (locally weighted).
struct ErrorBound {
  double floor_N = 0.0, per_force = 0.0, per_distance_N = 0.0;

  // `beyond`: distance - inner radius. An infinite distance gives an infinite bound.
  double at(double force_N, double beyond) const noexcept {
    return floor_N + per_force * std::abs(force_N) + per_distance_N * std::max(0.0, beyond);
  }
};

// Of the features.
struct Normalisation {
  Eigen::VectorXd offset;  // SI
  Eigen::VectorXd scale;   // SI, > 0; 1 for a feature that never changes
  Eigen::VectorXd lower;   // bounds in contact, SI
  Eigen::VectorXd upper;

  // Upper minus lower bound; 0 at the level of rounding.
  double range(Eigen::Index feature) const;
  // The scale range^a (4 sigma)^(1 - a) of each feature; a = 1/2 gives `scale`.
  Eigen::VectorXd scale_of(double range_exponent) const;
};

struct ModelData : Normalisation {
  std::string name;    // of its plan (models/fit/model_plan.h), e.g. "trend+greedy-100"
  std::string method;  // the name without the number of centres, e.g. "trend+greedy"
  std::vector<FeatureSpec> features;
  Trend trend;
  double correction_limit_N = 0.0;
  double largest_force_N = 0.0;  // of the training data; the output is at most 1.2 times this
  double lowest_force_N = 0.0;   // of the training data if the material pulls, else 0; <= 0
  // The force at the outer end of recordings that never leave the material; else 0. In air the model's force is 0, so
  // that it steps there, and the model is out of its domain above the recorded depths.
  double surface_step_N = 0.0;
  // Of each recording of the provenance, in its order; empty: not known, and every stream begins at rest.
  std::vector<RecordingEnds> ends;
  DomainCover cover;
  std::optional<ErrorBound> error_bound;  // none of a fit to the measured force, or to a single press
  // The position sensor of the training recordings, the coarsest of them: the default sensor of streams and exported
  // files; no effect on the force of a feature vector. None: not known.
  std::optional<SensorSpec> sensor;
  JndLine jnd;
  CorrectionPtr correction;  // h; shared by copies; null: none
  Provenance provenance;

  // Of the correction: its centres, or the nodes of its grid.
  int centre_count() const noexcept { return correction ? correction->size() : 0; }
};

inline constexpr double kForceMargin = 1.2;
// The inner radius of a trust that is 1 everywhere: normalised features are about 1.
inline constexpr double kEverywhere = 1e6;

// Checks the forces at the points of the cover. Errors: a part of the force is not finite or far above the limits of
// the model.
Status check_forces(const ModelData& data);
// The sensor of a tool with this encoder step: the sensor of the training recordings if the step is theirs or 0 (not
// known), else one with this step and no noise.
SensorSpec sensor_with_step(const ModelData& data, double encoder_step_m);

// How a stream of this model began (HapticsTick::began): "at rest", "as the end of NAME", or "as the end of the
// recording before".
std::string began_words(const ModelData& data, int began);

class FittedModel final : public ForceModel {
 public:
  // `data`: from a fit or a file, with sizes that match.
  explicit FittedModel(ModelData data);

  double force(const double* features) const noexcept override;
  void assess(const double* features, ForceEstimate& estimate) const noexcept override;
  const std::vector<FeatureSpec>& features() const noexcept override { return data_.features; }
  // The greatest depth in the domain; a greater one is out of it at any distance from the data. Infinite without a
  // depth feature.
  double deepest_m() const noexcept override { return deepest_m_; }
  double shallowest_m() const noexcept override { return shallowest_m_; }
  const std::vector<RecordingEnds>& ends() const noexcept override { return data_.ends; }
  const std::string& name() const noexcept override { return data_.name; }
  const std::string& method() const noexcept override { return data_.method; }
  int centre_count() const noexcept override { return data_.centre_count(); }

  const ModelData& data() const noexcept { return data_; }
  // The index of the depth feature; 0 without one.
  std::size_t depth_feature() const noexcept { return depth_; }

 private:
  std::array<double, kMaxFeatures> normalised(const double* features) const noexcept {
    std::array<double, kMaxFeatures> u;
    for (std::size_t i = 0; i < dimension_; ++i) u[i] = (features[i] - offset_[i]) * inverse_scale_[i];
    return u;
  }

  ModelData data_;
  TrendInputs trend_inputs_;
  DomainGuard guard_;
  std::size_t dimension_ = 0;
  std::size_t depth_ = 0;
  double deepest_m_ = std::numeric_limits<double>::infinity(), shallowest_m_ = 0.0;
  bool trusts_everywhere_ = false;
  std::array<double, kMaxFeatures> offset_{};
  std::array<double, kMaxFeatures> inverse_scale_{};
};

}  // namespace palpate
