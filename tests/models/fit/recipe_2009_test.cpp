#include <gtest/gtest.h>

#include "tests/support/fitting.h"

namespace palpate {
namespace {

TEST(Recipe2009, FitsTwoTimesToTheRecording) {
  const TrainingRequest request = recipe_2009_request(test::default_request("silicone_block"));
  EXPECT_EQ(request.reduction, Reduction::force);
  EXPECT_EQ(request.weighting, Weighting::relative);
  EXPECT_EQ(request.surface, Surface::recorded);
  RigSettings settings = test::train_settings("gel");  // 0.05, 0.3, 2 s, unlike the times of the scene
  settings.seconds = 15.0;
  const PreparedTraining prepared = test::prepare({test::rig_recording(settings)}, request);
  const std::vector<double> times_s = relaxation_times_s(prepared.common.features);
  ASSERT_EQ(times_s.size(), 2u);
  EXPECT_LT(times_s[0], times_s[1]);
  std::size_t low_pass = 0;
  for (const FeatureSpec& spec : prepared.common.features) low_pass += spec.kind == FeatureKind::lowpass_velocity;
  EXPECT_EQ(low_pass, 2u);
}

TEST(Recipe2009, TrustsItsFunctionEverywhere) {
  TrainingRequest request = recipe_2009_request(test::default_request("silicone_block"));
  request.relaxation = Relaxation::scene;
  RigSettings settings = test::train_settings("silicone");
  settings.seconds = 8.0;
  const PreparedTraining prepared = test::prepare({test::rig_recording(settings)}, request);
  EXPECT_TRUE(prepared.sites.as_2009);
  EXPECT_FALSE(prepared.common.corrects_trend);
  EXPECT_EQ(prepared.set.reduction_force_N, 0.05);
  Eigen::VectorXd far = Eigen::VectorXd::Constant(prepared.sites.dimension(), 50.0);
  EXPECT_EQ(DomainGuard(prepared.common.cover).trust(far.data()), 1.0);
}

TEST(Recipe2009, OfPositionAloneHasNoTimes) {
  EXPECT_EQ(recipe_2009_request(test::position_request()).relaxation, Relaxation::scene);
}

}  // namespace
}  // namespace palpate
