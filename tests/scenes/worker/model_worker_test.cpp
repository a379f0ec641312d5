// The worker makes the same models as palpate fit, the fastest of a kind first, and can be interrupted.
#include "scenes/worker/model_worker.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <thread>

#include "engine/recording/recording.h"
#include "scenes/material/rig.h"
#include "tests/support/example_model.h"
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

ModelRequest request_of(const std::string& name) { return {test::must(parse_plan(name))}; }

// The model of palpate fit.
FittedModel fitted(const std::string& scene, const std::string& name) {
  const Scene loaded = test::must(load_scene(scene));
  ModelFits fits({prepare_recording(test::must(record_sensors({*loaded.material, 1})))}, training_scene(loaded));
  return FittedModel(test::must(fits.fit(test::must(parse_plan(name)), {})).model->data());
}

void expect_equal(const FittedModel& one, const FittedModel& other) {
  EXPECT_EQ(one.name(), other.name());
  for (double depth_m = 0.0; depth_m < 0.02; depth_m += 1e-4) {
    const std::array<double, kMaxFeatures> held{depth_m};  // at rest
    ASSERT_EQ(one.evaluate(held.data()).force_N, other.evaluate(held.data()).force_N);
  }
}

TEST(ModelWorker, EqualsPalpateFitAndFitsTheFastestOfAKindFirst) {
  ModelWorker worker(test::must(load_scene("elastic_block")), 1);
  worker.add_job(3, request_of("kdtree-20"));
  worker.add_job(5, request_of("random-20"));
  worker.add_job(7, request_of("trend+greedy-20"));
  ASSERT_TRUE(worker.start().ok());
  const std::vector<FinishedModel> made = wait_for(worker, 3);
  std::vector<std::size_t> on_the_force;
  for (const FinishedModel& one : made) {
    if (one.job_id != 7) on_the_force.push_back(one.job_id);
    const char* name = one.job_id == 3 ? "kdtree-20" : one.job_id == 5 ? "random-20" : "trend+greedy-20";
    expect_equal(*test::must(one.model), fitted("elastic_block", name));
  }
  EXPECT_EQ(on_the_force, (std::vector<std::size_t>{5, 3}));
  EXPECT_EQ(worker.left_s(), 0.0);
}

// A slider requests several numbers of centres, before what waits.
TEST(ModelWorker, ARequestAtOnceComesBeforeThoseThatWait) {
  ModelWorker worker(test::must(load_scene("elastic_block")), 1);
  worker.add_job(1, request_of("random-10"));
  worker.add_job(2, request_of("voxel"));
  worker.add_job(1, request_of("random-12"), true);
  worker.add_job(1, request_of("random-3"), true);
  EXPECT_GT(worker.left_s(), 0.0);
  ASSERT_TRUE(worker.start().ok());
  const std::vector<FinishedModel> made = wait_for(worker, 2);
  EXPECT_EQ(made[0].job_id, 1u);
  EXPECT_EQ(made[0].centres, 3) << "the last request replaces those before";
  EXPECT_EQ(made[1].job_id, 2u);
}

TEST(ModelWorker, ARecordingReplacesTheMaterial) {
  Scene scene = test::must(load_scene("skin"));
  scene.recordings = {"mine.csv"};
  ModelWorker worker(scene, 1, {test::example_recording(3000, 1000.0)});
  const auto model = test::must(worker.make(request_of("random-10")));
  const std::array<double, kMaxFeatures> held{0.004};
  EXPECT_NEAR(model->evaluate(held.data()).force_N, 300.0 * 0.004, 0.1) << "a spring of 300 N/m";
}

TEST(ModelWorker, ReportsErrors) {
  ModelWorker worker(test::must(load_scene("skin")), 1);
  ASSERT_TRUE(worker.start().ok());
  worker.add_job(2, request_of("greedy"));
  EXPECT_TRUE(test::has_parts(wait_for(worker, 1)[0].model, {"\"skin\""}));
}

// A cancelled fit gives no model, and the next one is made.
TEST(ModelWorker, AFitIsCancelledAndTheEstimateDoesNotGrow) {
  ModelWorker worker(test::must(load_scene("elastic_block")), 1);
  worker.add_job(1, request_of("greedy-200"), true);
  worker.add_job(2, request_of("greedy-100"));
  worker.add_job(3, request_of("random-10"));
  ASSERT_TRUE(worker.start().ok());
  while (!worker.progress()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  double left_s = worker.left_s();
  worker.cancel_job(1);
  worker.cancel_job(2);
  std::vector<FinishedModel> made;
  while (made.empty()) {
    made = worker.read_finished();
    EXPECT_LE(worker.left_s(), left_s);
    left_s = worker.left_s();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(made[0].job_id, 3u);
}

TEST(ModelWorker, EndsInTheMiddleOfAFit) {
  ModelWorker worker(test::must(load_scene("silicone_block")), 1);
  for (std::size_t i = 0; i < 8; ++i) worker.add_job(i, request_of("greedy"));
  ASSERT_TRUE(worker.start().ok());
  while (!worker.progress()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_GT(worker.left_s(), 0.0);
}

}  // namespace
}  // namespace palpate
