// A fitted force model: everything that evaluation needs, as data, and the
// ForceModel that computes it.
//
//   f(x) = clamp( T(x) + g(u) clamp(h(u) - b(x), -limit, limit), lowest, largest )
//   u = (x - offset) / scale                                    normalised features
//
// T: the trend (models/model/trend.h). h: the correction (models/model/correction.h):
// eq. 2 of Hoever & Harders (2009), its grid, or none at all. g: trust, 1 near the data, 0 out of domain
// (models/model/domain_guard.h). b: 0 when h was fitted to what the trend leaves over (default), T(x) when h was fitted
// to the force itself (the paper's own recipe). limit: the largest correction that the training data called for.
// largest: 1.2 x the largest training force. lowest: the lowest one where a material that sticks to the tool was
// recorded, else 0. So out of its domain every method is the trend: continuous, bounded, and never pulling the tool in
// by more than the material did.
//
// Thread guarantee: FittedModel is immutable; `evaluate` as in ForceModel.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/tick/force_model.h"
#include "engine/tick/jnd.h"
#include "models/model/correction.h"
#include "models/model/domain_guard.h"
#include "models/model/error_bound.h"
#include "models/model/trend.h"

namespace palpate {

struct RelaxationTime {
  double time_s = 0.0;
  double standard_error_s = 0.0;  // 0: given, not identified
};

// How a training recording lies to the others of its set, what its force sensor reads in
// air, and how late that is; all were taken off.
struct RecordingSurface {
  std::string name;
  double offset_m = 0.0;
  double standard_error_m = 0.0;  // infinite: not known
  double force_zero_N = 0.0;
  double lag_s = 0.0;              // by which the forces were moved back
  std::uint64_t content_hash = 0;  // of its rows as recorded; not in files
};

// What the positions of the training recordings came in: the coarsest of them.
struct PositionSensor {
  double encoder_step_m = 0.0;    // 0: not quantised
  double position_noise_m = 0.0;  // standard deviation beside the quantisation
};

// Where a model comes from; no effect on its forces.
struct Provenance {
  std::vector<std::string> recordings;
  std::vector<RecordingSurface> surfaces;  // empty: positions as recorded
  std::string scene;
  std::uint64_t samples = 0;  // rows of all recordings
  std::uint64_t contact_samples = 0;
  std::uint64_t samples_after_reduction = 0;
  std::uint64_t seed = 0;
  std::string weighting;   // jnd, relative, none
  std::string reduction;   // coverage, force, none
  std::string relaxation;  // scene, auto, given
  std::vector<RelaxationTime> relaxation_times;
  double training_within_jnd = 0.0;
};

struct ModelData {
  std::string name;    // e.g. "greedy-100"
  std::string method;  // a row's name in models/fit/methods.h, e.g. "greedy"
  std::vector<FeatureSpec> features;
  Eigen::VectorXd offset;  // per feature, SI
  Eigen::VectorXd scale;   // per feature, SI, > 0
  Eigen::VectorXd lower;   // bounds of the training data, SI
  Eigen::VectorXd upper;
  Trend trend;
  bool corrects_trend = true;  // h was fitted to f - T; false: to f
  double correction_limit_N = 0.0;
  double largest_force_N = 0.0;  // of the training data; output stays below 1.2 times it
  double lowest_force_N = 0.0;   // <= 0; of the training data where they pull, else 0
  DomainCover cover;
  std::optional<ErrorBound> error_bound;  // none in files of before, and of the paper's recipe
  // No effect on the force of a feature vector: what a stream, or an exported file, takes
  // for its own sensor when it is told nothing. None in files of before.
  std::optional<PositionSensor> sensor;
  JndLine jnd;
  CorrectionPtr correction;  // h; shared by copies
  Provenance provenance;
};

inline constexpr double kForceMargin = 1.2;

// Checks sizes, signs and finiteness of everything above. Errors: names the
// field, what was found and what was expected.
Status validate_model(const ModelData& data);

// The sensor of a tool of which only the step is known: with the training recordings'
// step, or with 0 for "not known", it is theirs; else that step and no noise.
PositionSensor sensor_with_step(const ModelData& data, double encoder_step_m);

// Depths beyond this are out of the domain whatever the guard's radius; infinite without
// a depth feature. `feature`: which one that is; 0 without.
double deepest_in_domain_m(const ModelData& data, std::size_t& feature);

class FittedModel final : public ForceModel {
 public:
  // `data` must pass validate_model.
  explicit FittedModel(ModelData data);

  ForceEstimate evaluate(const double* features) const noexcept override;
  const std::vector<FeatureSpec>& features() const noexcept override { return data_.features; }
  const std::string& name() const noexcept override { return data_.name; }
  const std::string& method() const noexcept override { return data_.method; }
  int centre_count() const noexcept override;

  const ModelData& data() const noexcept { return data_; }

 private:
  ModelData data_;
  TrendInputs trend_inputs_;
  DomainGuard guard_;
  const Correction* correction_ = nullptr;  // of data_; null when the trend stands alone
  std::size_t dimension_ = 0;
  std::size_t depth_ = 0;   // which feature
  double deepest_m_ = 0.0;  // depths beyond are out of the domain whatever the guard's radius
  std::array<double, kMaxFeatures> offset_{};
  std::array<double, kMaxFeatures> inverse_scale_{};
};

}  // namespace palpate
