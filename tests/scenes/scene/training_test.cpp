#include "scenes/scene/training.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Training, TakesTheScenesFeaturesAndJnd) {
  Scene scene = load_scene("silicone_block").value();
  scene.jnd.offset_N = 0.25;
  const TrainingRequest request = training_request(scene);
  EXPECT_EQ(request.scene, "silicone_block");
  EXPECT_EQ(request.features, scene.features);
  EXPECT_EQ(request.jnd.offset_N, 0.25);
  const TrainingRequest position = position_request(scene);
  EXPECT_EQ(position.features, std::vector<FeatureSpec>{FeatureSpec{}});
  EXPECT_EQ(position.jnd.offset_N, 0.25);
}

}  // namespace
}  // namespace palpate
