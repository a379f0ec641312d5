// Models fitted by the build are those that a session would fit, and serve no other scene, seed or plan.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>

#include "scenes/worker/model_worker.h"
#include "tests/support/message_parts.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

TEST(ReadyModels, AreThoseThatASessionWouldFitAndServeNoOtherSceneSeedOrPlan) {
  const test::TemporaryFolder folder;
  const std::string ready = folder.file("ready");
  const Scene scene = test::must(load_scene("elastic_block"));
  ASSERT_TRUE(make_ready_models(ready, scene.name).ok());
  ModelWorker with(scene, 1, {}, ready), without(scene, 1);
  for (const ModelRequest& request : test::must(requested_models(scene, {}))) {
    EXPECT_FALSE(with.ready_file(request.plan).empty()) << plan_name(request.plan);
    const auto read = test::must(with.make(request)), fitted = test::must(without.make(request));
    EXPECT_EQ(read->name(), fitted->name());
    for (int i = 0; i < 50; ++i) {
      const std::array<double, kMaxFeatures> values{1e-4 * i};
      ASSERT_EQ(read->evaluate(values.data()).force_N, fitted->evaluate(values.data()).force_N);
    }
  }
  for (const ModelRequest& request : test::must(requested_models(scene, exhibit_models())))
    EXPECT_FALSE(with.ready_file(request.plan).empty()) << plan_name(request.plan);

  const ModelPlan plan = test::must(parse_plan("random-100"));
  EXPECT_EQ(ModelWorker(scene, 2, {}, ready).ready_file(plan), "");
  EXPECT_EQ(ModelWorker(scene, 1, {}, "").ready_file(plan), "");
  EXPECT_EQ(ModelWorker(test::must(load_scene("stiff_block")), 1, {}, ready).ready_file(plan), "");
  Scene other = scene;
  other.material = "stiff";
  EXPECT_EQ(ModelWorker(other, 1, {}, ready).ready_file(plan), "");
  other = scene;
  other.jnd.weber_fraction = 0.07;
  EXPECT_EQ(ModelWorker(other, 1, {}, ready).ready_file(plan), "");
  EXPECT_EQ(with.ready_file(test::must(parse_plan("random-99"))), "");
  EXPECT_EQ(with.ready_file(test::must(parse_plan_options("method=random seed=2"))), "");

  // Instead of a damaged file the worker makes the fit.
  std::filesystem::resize_file(ready + "/elastic_block/random-100.json", 1000);
  EXPECT_EQ(test::must(with.make({plan}))->name(), "random-100");
}

}  // namespace
}  // namespace palpate
