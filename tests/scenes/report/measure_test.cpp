#include "scenes/report/measure.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "models/model/fitted_model.h"
#include "models/samples/recording_faults.h"
#include "scenes/evaluation/ranking.h"
#include "scenes/material/rig.h"
#include "scenes/report/plan.h"
#include "tests/support/example_model.h"
#include "tests/support/fitting.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

TEST(Plan, BeginsWithNoForceAndHasBothRecipesInEverySize) {
  for (const bool quick : {true, false}) {
    const std::vector<PlannedModel> plan = make_plan(quick, 4);
    EXPECT_EQ(plan[0].recipe, Recipe::no_force);
    EXPECT_EQ(plan[1].name, "trend");
    std::size_t paper = 0;
    std::size_t slow = 0;
    for (const PlannedModel& model : plan) {
      paper += model.recipe == Recipe::paper ? 1 : 0;
      slow += model.request.method == find_method("direct") ? 1 : 0;
      const Method* base = model.request.method->base;
      if (base == nullptr || model.recipe == Recipe::paper) continue;
      EXPECT_TRUE(
          std::any_of(plan.begin(), plan.end(), [&](const PlannedModel& one) { return one.request.method == base; }));
    }
    EXPECT_GE(paper, 9u);
    EXPECT_EQ(slow, quick ? 0u : 2u);
  }
}

ModelResult result(const char* name, Recipe recipe, double p99, double tick_ns, bool main = true) {
  ModelResult one;
  one.plan.name = name;
  one.plan.recipe = recipe;
  one.plan.main = main;
  one.model = std::make_shared<const FittedModel>(test::example_models().front());
  one.errors.p99_error_over_jnd = p99;
  one.time.tick = {tick_ns, tick_ns, tick_ns, tick_ns};
  return one;
}

ModelResult trend(double p99, double tick_ns) {
  ModelResult one = result("trend", Recipe::palpate, p99, tick_ns);
  one.plan.request.method = &kTrendMethod;
  return one;
}

TEST(Choose, TakesOneSizeOfEachMethodAndTheFastestThatQualifies) {
  const Choice choice =
      choose({ModelResult{}, trend(2.0, 100.0), result("greedy-100", Recipe::palpate, 0.5, 300.0),
              result("greedy-200", Recipe::palpate, 0.1, 310.0, false), result("voxel", Recipe::palpate, 0.6, 200.0)});
  EXPECT_EQ(choice.candidates, (std::vector<std::size_t>{1, 2, 4}));
  EXPECT_EQ(choice.recommended, 4u);
  EXPECT_EQ(choice.best, 2u);
  EXPECT_FALSE(choice.correction_off);
  EXPECT_TRUE(choose({ModelResult{}, trend(2.0, 100.0)}).correction_off);
}

TEST(Choose, NamesAnotherSizeThatIsFasterAndMoreAccurate) {
  const Choice choice = choose({ModelResult{}, result("greedy-100", Recipe::palpate, 0.5, 300.0),
                                result("greedy-10", Recipe::palpate, 0.4, 100.0, false),
                                result("greedy-20", Recipe::palpate, 0.3, 110.0, false),
                                result("greedy-200", Recipe::palpate, 0.1, 310.0, false)});
  EXPECT_EQ(choice.recommended, 1u) << "a size is not chosen by the test";
  EXPECT_EQ(choice.dominating, 3u);
}

TEST(Choose, OnEveryRecordedSetNoMethodDominatesTheRecommendedOne) {
  int sets = 0;
  for (const std::filesystem::path& folder : {test::real_data(), test::real_data() / "../labs"}) {
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& set : std::filesystem::directory_iterator(folder)) {
      std::vector<PreparedRecordingPointer> recordings[2];
      if (!set.is_directory()) continue;
      for (const auto& file : std::filesystem::directory_iterator(set.path())) {
        const std::string name = file.path().filename().string();
        const bool tested = name.find("test") != std::string::npos;
        if (file.path().extension() != ".csv" || (!tested && name.find("train") == std::string::npos)) continue;
        recordings[tested].push_back(prepare_recording(*read_usable_recording(file.path().string())));
      }
      const auto split = split_recordings(recordings[0], recordings[1]);
      if (recordings[0].empty() || recordings[1].empty() || !split.ok()) continue;  // no test, or one trained on
      const auto data = measure(*split, *load_scene("silicone_block"), true, {});
      ASSERT_TRUE(data.ok()) << set.path() << data.error().message;
      ++sets;
      const auto entry = [&](std::size_t i) { return Candidate{data->models[i].errors, data->models[i].time.tick}; };
      for (std::size_t i = 1; i < data->models.size(); ++i) {
        if (!data->models[i].plan.main && dominates(entry(i), entry(data->choice.recommended))) {
          EXPECT_TRUE(data->choice.dominating.has_value()) << set.path() << ": the answer names no other size";
        }
      }
      for (const std::size_t i : data->choice.candidates) {
        EXPECT_FALSE(dominates(entry(i), entry(data->choice.recommended)))
            << set.path() << ": " << data->models[i].plan.name << " dominates "
            << data->models[data->choice.recommended].plan.name;
      }
    }
  }
  if (sets == 0) GTEST_SKIP() << "skipped: the recordings are not there";
  EXPECT_GE(sets, 10);
}

TEST(WorstStretch, IsWhereTheFirstModelErrs) {
  // 12 s; from 7 to 8 s the measured force is 50 N larger.
  Recording recording = test::example_recording(12000, 1000.0);
  for (RecordingRow& row : recording.rows) {
    const double since_s = row.time_s - recording.rows.front().time_s;
    if (since_s >= 7.0 && since_s < 8.0) row.force_N += 50.0;
  }
  const auto model = std::make_shared<const FittedModel>(test::example_models().front());
  const WorstStretch worst = worst_stretch(recording, {model, model}, JndLine{});
  ASSERT_FALSE(worst.rows.empty());
  const double from_s = worst.rows.front().time_s - recording.rows.front().time_s;
  const double to_s = worst.rows.back().time_s - recording.rows.front().time_s;
  EXPECT_NEAR(to_s - from_s, kStretchSeconds, 2e-3);
  EXPECT_LE(from_s, 7.0);
  EXPECT_GE(to_s, 7.9);
  EXPECT_EQ(worst.rows[10].force_N.size(), 2u);
}

TEST(WorstStretch, OfAShortRecordingIsTheWhole) {
  const Recording recording = test::example_recording(500, 1000.0);
  const auto model = std::make_shared<const FittedModel>(test::example_models().front());
  EXPECT_EQ(worst_stretch(recording, {model}, JndLine{}).rows.size(), 500u);
}

// In one fold the recipe of 2009 has fewer sites than centres, in the other more.
TEST(Measure, ANameHasTheNumberOfCentresInEveryOrderOfTheFolds) {
  const auto scene = test::must(load_scene("silicone_block"));
  for (const bool long_first : {false, true}) {
    std::vector<PreparedRecordingPointer> recordings;
    for (const bool first : {true, false}) {
      Recording recording = *record_sensors({"silicone", first ? 1U : 2U, first == long_first ? 20.0 : 4.0, 100.0});
      recording.name = first ? "a" : "b";
      recordings.push_back(prepare_recording(std::move(recording)));
    }
    const auto set = test::must(split_recordings(recordings, {}));
    const auto data = test::must(measure(set, scene, true, {}));
    for (const ModelResult& one : data.models) {
      if (!one.model || !one.plan.request.method->can_take(kTakesCentres)) continue;
      EXPECT_EQ(one.plan.name, model_name(one.plan.recipe, *one.plan.request.method, one.size));
    }
  }
}

}  // namespace
}  // namespace palpate
