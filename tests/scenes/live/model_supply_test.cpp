// The same models as palpate fit makes, the quickest first, and gone when told.
#include "scenes/live/model_supply.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "models/model/file/model_io.h"
#include "tests/support/example_model.h"
#include "tests/support/fitting.h"
#include "tests/support/temporary_folder.h"

namespace palpate {
namespace {

std::vector<SuppliedModel> wait_for(ModelSupply& supply, std::size_t count) {
  std::vector<SuppliedModel> all;
  while (all.size() < count) {
    for (SuppliedModel& one : supply.take()) all.push_back(std::move(one));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return all;
}

TEST(ModelSupply, FitsWhatPalpateFitDoesTheQuickestFirst) {
  ModelSupply supply(test::must(load_scene("elastic_block")), 1);
  supply.order(7, {ModelOrigin::position, &kGreedyMethod, ""});
  supply.order(3, {ModelOrigin::method, &kKdTreeMethod, ""});
  supply.order(5, {ModelOrigin::method, &kRandomMethod, ""});
  ASSERT_TRUE(supply.start().ok());
  const std::vector<SuppliedModel> made = wait_for(supply, 3);
  EXPECT_EQ(made[0].ticket, 5u);
  EXPECT_EQ(made[1].ticket, 3u);
  EXPECT_EQ(made[2].ticket, 7u);
  const PreparedTraining prepared =
      test::prepare({test::rig_recording(test::train_settings("elastic"))}, test::scene_request("elastic_block"));
  const std::vector<test::ModelPtr> expected{test::fit(prepared, &kRandomMethod), test::fit(prepared, &kKdTreeMethod),
                                             test::fit(prepared, &kGreedyMethod)};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NE(made[i].model, nullptr) << made[i].problem;
    for (double depth_m = 0.0; depth_m < 0.02; depth_m += 1e-4) {
      ASSERT_EQ(made[i].model->evaluate(&depth_m).force_N, expected[i]->evaluate(&depth_m).force_N) << i;
    }
  }
}

TEST(ModelSupply, ReadsFilesAndSaysWhatIsWrong) {
  const test::TemporaryFolder folder;
  const ModelData data = test::example_model("greedy", KernelKind::cubic, test::position_features(), 1);
  ASSERT_TRUE(save_model(folder.file("good.json"), data, false).ok());
  const std::string bad = folder.with_file("bad.json", "{}");
  ModelSupply supply(test::must(load_scene("skin")), 1);
  ASSERT_TRUE(supply.start().ok());
  supply.order(0, {ModelOrigin::file, &kGreedyMethod, folder.file("good.json")});
  supply.order(1, {ModelOrigin::file, &kGreedyMethod, bad});
  supply.order(2, {ModelOrigin::method, &kGreedyMethod, ""});
  const std::vector<SuppliedModel> made = wait_for(supply, 3);
  ASSERT_NE(made[0].model, nullptr) << made[0].problem;
  EXPECT_EQ(made[0].model->name(), data.name);
  EXPECT_EQ(made[1].model, nullptr);
  EXPECT_NE(made[1].problem.find("bad.json"), std::string::npos) << made[1].problem;
  EXPECT_EQ(made[2].problem, "the scene \"skin\" has no virtual material to fit a model to");
}

TEST(ModelSupply, EndsInTheMiddleOfAFit) {
  ModelSupply supply(test::must(load_scene("silicone_block")), 1);
  for (std::size_t i = 0; i < 8; ++i) supply.order(i, {ModelOrigin::method, &kGreedyMethod, ""});
  ASSERT_TRUE(supply.start().ok());
  while (supply.progress().share <= 0.0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(supply.progress().working);
}

}  // namespace
}  // namespace palpate
