#include "scenes/scene/recipe_fits.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/fitting.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

TEST(RecipeFits, OneNameForAModel) {
  EXPECT_EQ(model_name(Recipe::palpate, kGreedyMethod, 100), "greedy-100");
  EXPECT_EQ(model_name(Recipe::palpate, kGreedyMethod, 0), "greedy");
  EXPECT_EQ(model_name(Recipe::paper, kGreedyMethod, 10), "2009-greedy-10");
  EXPECT_EQ(model_name(Recipe::paper, kVoxelMethod, 10), "2009-voxel");
  EXPECT_EQ(model_name(Recipe::position, kGreedyMethod, 10), "position only");
  EXPECT_EQ(model_name(Recipe::no_force, kTrendMethod, 10), "no force");
}

TEST(RecipeFits, PreparesOnceAndStartsFromTheBase) {
  const Scene scene = test::must(load_scene("elastic_block"));
  const auto recording = test::rig_recording(test::train_settings("elastic"));
  RecipeFits fits({prepare_recording(*recording)}, scene);
  const PreparedTraining* prepared = test::must(fits.prepare(Recipe::paper, {}));
  EXPECT_EQ(test::must(fits.prepare(Recipe::paper, {})), prepared);
  const auto direct = test::must(fits.fit(Recipe::paper, {.method = &kDirectMethod}, {}));
  const auto voxel = test::must(fits.fit(Recipe::paper, {.method = &kVoxelMethod}, {}));
  EXPECT_GT(voxel.seconds, direct.seconds) << "with the time of the base";
  const FittedModel from_base(voxel.data);
  const FittedModel alone(test::must(fit_method(*prepared, {.method = &kVoxelMethod})).data);
  for (double depth_m = 0.0; depth_m < 0.02; depth_m += 1e-4) {
    const std::array<double, kMaxFeatures> held{depth_m};
    ASSERT_EQ(from_base.evaluate(held.data()).force_N, alone.evaluate(held.data()).force_N);
  }
}

}  // namespace
}  // namespace palpate
