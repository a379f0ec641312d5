#include "scenes/report/measure.h"

#include <gtest/gtest.h>

#include <set>

#include "models/correction/methods.h"
#include "scenes/material/rig.h"
#include "tests/support/example_model.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

ModelResult result(const char* name, double p99, double tick_ns) {
  ModelResult one;
  one.name = name;
  one.plan = test::must(parse_plan(name));
  one.model = std::make_shared<const FittedModel>(test::example_models().front());
  one.errors.p99_error_over_jnd = p99;
  one.errors.within_jnd = p99 > 1.0 ? 0.9 : 0.995;
  one.time = {{tick_ns, tick_ns, tick_ns, tick_ns}, {}, true};
  return one;
}

TEST(Choose, EveryModelIsACandidateAndTheFastestNearTheBestIsTaken) {
  const Ranking choice = choose({ModelResult{}, result("trend", 2.0, 100.0), result("trend+greedy-100", 0.45, 300.0),
                                 result("trend+greedy-20", 0.48, 150.0), result("voxel", 0.4, 200.0)});
  EXPECT_EQ(choice.as_good, (std::vector<bool>{false, false, true, true, true})) << "no force is none";
  EXPECT_EQ(choice.best, 4u);
  EXPECT_EQ(choice.recommended, 3u);
}

TEST(TestCurves, TheWorstStretchIsWhereTheFirstModelErrsWithoutFreeAir) {
  // 12 s; from 7 to 8 s the measured force is 50 N larger.
  Recording recording = test::example_recording(12000, 1000.0);
  for (RecordingRow& row : recording.rows) {
    const double since_s = row.time_s - recording.rows.front().time_s;
    if (since_s >= 7.0 && since_s < 8.0) row.force_N += 50.0;
  }
  const auto model = std::make_shared<const FittedModel>(test::example_models().front());
  const TestCurves curves = test_curves(recording, {model, model}, JndLine{});
  ASSERT_EQ(curves.moments.size(), recording.rows.size());
  const double from_s = curves.moments[curves.first].time_s - recording.rows.front().time_s;
  const double to_s = curves.moments[curves.last].time_s - recording.rows.front().time_s;
  EXPECT_LE(to_s - from_s, kStretchSeconds + 2e-3);
  EXPECT_LE(from_s, 7.1);
  EXPECT_GE(to_s, 7.9);
  EXPECT_EQ(curves.moments[10].force_N.size(), 2u);
}

// Two recordings without a test, in both orders: two folds, of which one has few sites. Their surfaces differ.
TEST(Measure, HasTheMainModelsWithFiveSeedsAndNamesWithTheNumberOfCentres) {
  const auto scene = test::must(load_scene("silicone_block"));
  for (const bool long_first : {false, true}) {
    std::vector<PreparedRecordingPointer> recordings;
    for (const bool first : {true, false}) {
      Recording recording = *record_sensors({"silicone", first ? 1U : 2U, first == long_first ? 20.0 : 4.0, 100.0});
      recording.name = first ? "a" : "b";
      for (RecordingRow& row : recording.rows) row.position_m += first ? 0.0 : 0.4e-3;
      recordings.push_back(prepare_recording(std::move(recording)));
    }
    const auto set = test::must(split_recordings(recordings, {}));
    const auto data = test::must(measure(set, scene, true, kBudget_ns, {}));
    EXPECT_EQ(data.models.front().name, "no force");
    std::set<std::string> families;
    for (const ModelResult& one : data.models) {
      EXPECT_EQ(one.errors.samples, data.models.front().errors.samples);
      if (!one.plan) continue;
      EXPECT_TRUE(is_main(*one.plan)) << one.name;
      EXPECT_TRUE(families.insert(family_name(*one.plan)).second) << one.name;
      EXPECT_EQ(one.seeds, one.plan->method->can_take(kTakesSeed) ? kSeeds : 1) << one.name;
      EXPECT_LE(one.p99_range.low, one.errors.p99_error_over_jnd);
      EXPECT_GE(one.p99_range.high, one.errors.p99_error_over_jnd);
      if (one.plan->base == Base::trend) {
        EXPECT_LT(one.moved.rms_error_N, one.errors.rms_error_N) << one.name;
      }
      EXPECT_EQ(one.bound.has_bounds(), one.plan->base == Base::trend) << one.name;
      if (one.size == 0 || !one.plan->selects_centres()) continue;
      EXPECT_EQ(one.name, family_name(*one.plan) + "-" + std::to_string(one.size));
    }
    for (const char* family : {"voxel", "random", "kdtree", "greedy", "trend"}) EXPECT_EQ(families.count(family), 1u);
    EXPECT_TRUE(families.count("trend+greedy") == 1 || !data.models.back().same.empty());
  }
}

}  // namespace
}  // namespace palpate
