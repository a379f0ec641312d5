// The interface of a force model to the tick: a feature vector in, a force out. And the motion that examines a model
// over its whole range, without a recording.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "engine/tick/features.h"

namespace palpate {

struct ForceEstimate {
  double force_N = 0.0;
  // The feature vector is outside the domain of the training data, where the force is mainly that of the trend
  // (models/model/fitted_model.h).
  bool out_of_domain = false;
  // 95 % bound on the error of the force, N; NaN if the model has none (models/model/fitted_model.h).
  double predicted_error_N = std::numeric_limits<double>::quiet_NaN();
};

// Immutable.
// Thread guarantee: `force`, `assess` and `evaluate` may run on any thread, also on several at once; they are
// wait-free, allocate nothing and never throw.
class ForceModel {
 public:
  virtual ~ForceModel() = default;

  // `features`: the values of `features()` in contact, SI units, finite. Returns a force of at most 1.2 x the largest
  // training force, negative only for a material that pulls, at most as strongly as it did in the training.
  virtual double force(const double* features) const noexcept = 0;
  // Determines domain and bound for `estimate.force_N`, the force of these features. A tick does so only where somebody
  // reads them, because the search for the nearest data takes longer than the force of a trend.
  virtual void assess(const double* features, ForceEstimate& estimate) const noexcept = 0;
  ForceEstimate evaluate(const double* features) const noexcept {
    ForceEstimate estimate{force(features)};
    assess(features, estimate);
    return estimate;
  }

  virtual const std::vector<FeatureSpec>& features() const noexcept = 0;
  // The position of its surface, m; all depths count from there.
  double surface_m() const noexcept { return surface_position_m(features()); }
  // The greatest depth that enters the memory of the features, m: that of the training domain.
  virtual double deepest_m() const noexcept { return std::numeric_limits<double>::infinity(); }
  // At a smaller depth, and in air, the model is out of its domain, m: above 0 if the training never left the material.
  virtual double shallowest_m() const noexcept { return 0.0; }
  // Of the training recordings: how a stream may begin.
  virtual const std::vector<RecordingEnds>& ends() const noexcept {
    static const std::vector<RecordingEnds> none;
    return none;
  }
  virtual const std::string& name() const noexcept = 0;    // e.g. "greedy-100"
  virtual const std::string& method() const noexcept = 0;  // e.g. "greedy"
  virtual int centre_count() const noexcept = 0;           // nodes for a grid
};

using ForceModels = std::vector<std::shared_ptr<const ForceModel>>;

// The motion of an exact tool from the surface of a model to its greatest depth. In equal steps of depth the tool comes
// to rest and makes one small cycle; then it makes two fast strokes over the whole range. Every judgement of a model
// without a recording uses it: impedance, equality, time, warm-up. Value type; wait-free.
class ProbingStrokes {
 public:
  static constexpr double kStep_s = 2e-3;
  static constexpr std::size_t kPlaces = 48, kRestSamples = 10, kCycleSamples = 20, kFastSamples = 512;
  static constexpr std::size_t kPlaceSamples = kRestSamples + kCycleSamples + 1;  // the cycle with both ends
  static constexpr std::size_t kSamples = kPlaces * kPlaceSamples + kFastSamples;

  explicit ProbingStrokes(const ForceModel& model) noexcept;

  // Sample `index` < kSamples.
  ToolSample at(std::size_t index) const noexcept;
  double cycle_m() const noexcept { return cycle_m_; }  // amplitude of the cycles

 private:
  double surface_m_, depth_m_, cycle_m_;
};

// The forces of a model over its ProbingStrokes. Two models are the same if these are equal.
struct ProbedForces {
  double surface_m = 0.0, deepest_m = 0.0;
  std::vector<double> forces_N;  // of each sample
  bool operator==(const ProbedForces&) const = default;
};
ProbedForces probed_forces(const std::shared_ptr<const ForceModel>& model);

}  // namespace palpate
