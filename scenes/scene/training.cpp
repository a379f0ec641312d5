#include "scenes/scene/training.h"

namespace palpate {

TrainingRequest training_request(const Scene& scene) {
  TrainingRequest request;
  request.scene = scene.name;
  request.features = scene.features;
  request.jnd = scene.jnd;
  request.choice = FeatureChoice::automatic;
  return request;
}

TrainingRequest position_request(const Scene& scene) {
  TrainingRequest request = training_request(scene);
  request.features = {FeatureSpec{}};
  request.choice = FeatureChoice::scene;
  return request;
}

}  // namespace palpate
