// The worker makes the same models as palpate fit, the fastest first, and can be interrupted.
#include "scenes/worker/model_worker.h"

#include <gtest/gtest.h>

#include <array>

#include <chrono>
#include <thread>

#include "tests/support/fitting.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

std::vector<FinishedModel> wait_for(ModelWorker& worker, std::size_t count) {
  std::vector<FinishedModel> all;
  while (all.size() < count) {
    for (FinishedModel& one : worker.read_finished()) all.push_back(std::move(one));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return all;
}

TEST(ModelWorker, EqualsPalpateFitAndFitsTheFastestFirst) {
  ModelWorker worker(test::must(load_scene("elastic_block")), 1);
  worker.add_job(7, {.recipe = Recipe::position});
  worker.add_job(3, {.method = &kKdTreeMethod});
  worker.add_job(5, {.method = &kRandomMethod});
  ASSERT_TRUE(worker.start().ok());
  const std::vector<FinishedModel> made = wait_for(worker, 3);
  EXPECT_EQ(made[0].job_id, 5u);
  EXPECT_EQ(made[1].job_id, 3u);
  EXPECT_EQ(made[2].job_id, 7u);
  const auto recording = test::rig_recording(test::train_settings("elastic"));
  const PreparedTraining prepared = test::prepare({recording}, test::default_request("elastic_block"));
  const PreparedTraining position = test::prepare({recording}, test::scene_request("elastic_block"));
  const std::vector<test::ModelPtr> expected{test::fit(prepared, &kRandomMethod), test::fit(prepared, &kKdTreeMethod),
                                             test::fit(position, &kGreedyMethod)};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto model = test::must(made[i].model);
    for (double depth_m = 0.0; depth_m < 0.02; depth_m += 1e-4) {
      const std::array<double, kMaxFeatures> held{depth_m};  // at rest
      ASSERT_EQ(model->evaluate(held.data()).force_N, expected[i]->evaluate(held.data()).force_N) << i;
    }
  }
}

// A slider requests several numbers of centres.
TEST(ModelWorker, AnotherNumberOfCentresEqualsPalpateFit) {
  constexpr double kRounding_N = 1e-9;
  ModelWorker worker(test::must(load_scene("elastic_block")), 1);
  SlotPlan plan;
  plan.method = &kKdTreeMethod;
  ASSERT_TRUE(worker.start().ok());
  const PreparedTraining prepared =
      test::prepare({test::rig_recording(test::train_settings("elastic"))}, test::default_request("elastic_block"));
  for (const int centres : {10, 12, 3}) {
    plan.centres = centres;
    worker.add_job(0, plan);
    const auto model = test::must(wait_for(worker, 1)[0].model);
    const FittedModel expected(test::must(fit_method(prepared, {plan.method, centres})).data);
    EXPECT_EQ(model->name(), expected.name());
    for (double depth_m = 0.0; depth_m < 0.02; depth_m += 1e-4) {
      const std::array<double, kMaxFeatures> held{depth_m};
      ASSERT_NEAR(model->evaluate(held.data()).force_N, expected.evaluate(held.data()).force_N, kRounding_N);
    }
  }
}

TEST(ModelWorker, ReportsErrors) {
  ModelWorker worker(test::must(load_scene("skin")), 1);
  ASSERT_TRUE(worker.start().ok());
  worker.add_job(2, {.method = &kGreedyMethod});
  EXPECT_TRUE(test::has_parts(wait_for(worker, 1)[0].model, {"\"skin\""}));
}

TEST(ModelWorker, EndsInTheMiddleOfAFit) {
  ModelWorker worker(test::must(load_scene("silicone_block")), 1);
  for (std::size_t i = 0; i < 8; ++i) worker.add_job(i, {.method = &kGreedyMethod});
  ASSERT_TRUE(worker.start().ok());
  while (worker.progress().share <= 0.0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(worker.progress().working);
}

}  // namespace
}  // namespace palpate
