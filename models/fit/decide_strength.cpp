#include "models/fit/decide_strength.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "models/fit/calibrate_bound.h"

namespace palpate {
namespace {

constexpr std::size_t kLeftOutSamples = 3000;
// How much larger the error on a new recording is, of which the trend has seen nothing:
// this power of how much worse the trend is on strokes left out than on its own data.
// Measured: with 2 the bounds hold 92 to 99 % on materials and real recordings.
constexpr double kSpreadPower = 2.0;
constexpr double kUnknownSpread = 1.25;  // when the features were given
constexpr std::size_t kFewStrokes = 5;
constexpr double kFewStrokesSpread = 1.2;
// One or two presses say nothing of how the next differs: 5 % of the force, as two
// specimens of a cast silicone do.
constexpr std::size_t kFewPresses = 3;
constexpr double kLeastPerForce = 0.05;

double spread_of(const FeatureSelection& selection, std::size_t strokes) {
  const double few = strokes < kFewStrokes ? kFewStrokesSpread : 1.0;
  if (!(selection.training_error_over_jnd > 0.0)) return few * kUnknownSpread;
  return few * std::pow(selection.left_out_error_over_jnd / selection.training_error_over_jnd, kSpreadPower);
}

std::vector<LeftOutSample> left_out_samples(const PreparedTraining& prepared) {
  const ModelData& common = prepared.common;
  const auto d = static_cast<Eigen::Index>(common.features.size());
  const std::size_t stride = prepared.evaluation_force_N.size() / kLeftOutSamples + 1;
  std::vector<LeftOutSample> samples;
  for (std::size_t i = 0; i < prepared.evaluation_force_N.size(); i += stride) {
    const double* features = prepared.evaluation_features[i].data();
    LeftOutSample sample;
    sample.point = (Eigen::Map<const Eigen::VectorXd>(features, d) - common.offset).cwiseQuotient(common.scale);
    sample.trend_N = common.trend.at(features, common.features);
    sample.force_N = prepared.evaluation_force_N[i];
    sample.depth_m = features[0];
    sample.fold = prepared.evaluation_fold[i];
    samples.push_back(std::move(sample));
  }
  return samples;
}

}  // namespace

void decide_strength(PreparedTraining& prepared, const JndLine& jnd, int folds, std::size_t strokes) {
  ModelData& common = prepared.common;
  const std::vector<LeftOutSample> samples = left_out_samples(prepared);
  StrengthInput input{prepared.sites, samples, folds, KernelKind::cubic, jnd};
  input.correction_limit_N = common.correction_limit_N;
  input.least_radius = common.cover.inner_radius;
  input.outer_to_inner = common.cover.outer_radius / common.cover.inner_radius;
  prepared.strength = choose_strength(input);
  prepared.sites.smoothing = prepared.strength->smoothing;
  prepared.sites.strength = prepared.strength->strength;
  const double spread = spread_of(prepared.selection, strokes);
  const auto bound_from = [&](const std::vector<LeftOutPrediction>& predictions) {
    auto bound = calibrate_bound(predictions, prepared.strength->inner_radius, jnd, common.largest_force_N, spread);
    if (bound && strokes < kFewPresses) bound->per_force = std::max(bound->per_force, kLeastPerForce);
    return bound;
  };
  common.error_bound = bound_from(prepared.strength->predictions);
  prepared.trend_bound = bound_from(prepared.strength->trend_predictions);
  common.cover.inner_radius = prepared.strength->inner_radius;
  common.cover.outer_radius = input.outer_to_inner * prepared.strength->inner_radius;
}

}  // namespace palpate
