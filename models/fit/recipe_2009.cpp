#include "models/fit/recipe_2009.h"

#include <algorithm>

namespace palpate {

TrainingRequest recipe_2009_request(TrainingRequest request) {
  request.recipe = FitRecipe::paper_2009;
  request.surface = Surface::recorded;
  request.reduction = Reduction::force;
  request.weighting = Weighting::relative;
  request.choice = FeatureChoice::scene;
  const bool relaxes = std::any_of(request.features.begin(), request.features.end(),
                                   [](const FeatureSpec& spec) { return spec.kind == FeatureKind::lowpass_velocity; });
  if (relaxes) {
    request.relaxation = Relaxation::automatic;
    request.relaxation_count = 2;
  }
  return request;
}

}  // namespace palpate
