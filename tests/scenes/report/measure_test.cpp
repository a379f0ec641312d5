#include "scenes/report/measure.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <set>
#include <utility>

#include "engine/base/random_stream.h"
#include "models/correction/methods.h"
#include "scenes/material/rig.h"
#include "scenes/report/paper.h"
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
      EXPECT_EQ(one.errors.bound.has_bounds(), one.plan->base == Base::trend) << one.name;
      if (one.size == 0 || !one.plan->selects_centres()) continue;
      EXPECT_EQ(one.name, family_name(*one.plan) + "-" + std::to_string(one.size));
    }
    for (const char* family : {"voxel", "random", "kdtree", "greedy", "trend"}) EXPECT_EQ(families.count(family), 1u);
    EXPECT_TRUE(families.count("trend+greedy") == 1 || !data.models.back().same.empty());
  }
}

using Names = std::multiset<std::string>;

// The example recording with sensor noise that is the name's own, because a copy would be refused.
Recording noisy(const std::string& name, std::size_t rows = 1000) {
  Recording recording = test::example_recording(rows, 1000.0);
  recording.name = name;
  RandomStream random(std::hash<std::string>{}(name), 0);
  for (RecordingRow& row : recording.rows) row.force_N += 0.005 * random.normal();
  return recording;
}

std::vector<PreparedRecordingPointer> prepared(const std::vector<Recording>& recordings) {
  std::vector<PreparedRecordingPointer> all;
  for (const Recording& one : recordings) all.push_back(prepare_recording(one));
  return all;
}

Result<RecordingSet> split(const std::vector<Recording>& train, const std::vector<Recording>& test) {
  return split_recordings(prepared(train), prepared(test));
}

Names names(const std::vector<PreparedRecordingPointer>& recordings) {
  Names names;
  for (const PreparedRecordingPointer& one : recordings) names.insert(one->recording.name);
  return names;
}

TEST(ReportRecordings, TrainAndTestStayApart) {
  const auto set = test::must(split({noisy("a"), noisy("b")}, {noisy("c")}));
  ASSERT_EQ(set.folds.size(), 1u);
  EXPECT_EQ(names(set.folds[0].train), (Names{"a", "b"}));
  EXPECT_EQ(names(set.folds[0].tested), (Names{"c"}));
  EXPECT_EQ(set.folds[0].words, "");
  EXPECT_EQ(set.trained, 2u);
  EXPECT_TRUE(set.is_tested(2));
  EXPECT_FALSE(set.is_tested(1));
  EXPECT_EQ(set.all[2]->recording.name, "c");
}

TEST(ReportRecordings, WithoutATestEveryRecordingIsTestedOnceByTheOthers) {
  std::vector<Recording> recordings;
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g"}) recordings.push_back(noisy(name));
  const auto set = test::must(split(recordings, {}));
  ASSERT_EQ(set.folds.size(), kMostFolds);
  Names tested;
  for (const Split& fold : set.folds) {
    EXPECT_TRUE(test::has_parts(fold.words, {"5-fold"}));
    EXPECT_EQ(fold.train.size() + fold.tested.size(), recordings.size());
    tested.merge(names(fold.tested));
    for (const PreparedRecordingPointer& one : fold.tested) {
      EXPECT_EQ(std::count(fold.train.begin(), fold.train.end(), one), 0);
    }
  }
  EXPECT_EQ(tested, (Names{"a", "b", "c", "d", "e", "f", "g"}));
  EXPECT_EQ(names(set.folds[0].tested), (Names{"a", "f"})) << "recordings with similar names are in other folds";
}

TEST(ReportRecordings, OfASingleOneABlockAtItsEndIsTested) {
  const auto set = test::must(split({noisy("a", 3000)}, {}));
  ASSERT_EQ(set.folds.size(), 1u);
  const Split& fold = set.folds.front();
  ASSERT_EQ(fold.train.size(), 1u);
  EXPECT_NEAR(fold.train[0]->recording.rows.back().time_s + 1e-3, fold.counted_from_s, 1e-9) << "the next row";
  EXPECT_TRUE(test::has_parts(fold.words, {"block at the end"}));
  EXPECT_EQ(fold.tested[0]->recording.rows.size(), 3000u);
  ASSERT_EQ(set.all.size(), 1u);
  EXPECT_EQ(set.trained, 1u);
  EXPECT_TRUE(set.is_tested(0)) << "by a fit to the rest of it";
}

TEST(ReportRecordings, RefusesUnusableRecordings) {
  EXPECT_TRUE(test::has_parts(split({noisy("short", 100)}, {}), {"100 rows", "1000", "--test"}));
  Recording air = noisy("air", 100);
  for (RecordingRow& row : air.rows) row.position_m = -1e-3 - 1e-6 * row.time_s;
  EXPECT_TRUE(test::has_parts(split({noisy("a")}, {air}), {"air: ", "position_m > 0", "; "}));
}

TEST(Leakage, ACopyUnderAnotherNameIsRefusedByName) {
  const Recording train = noisy("train");
  Recording copy = train;
  copy.name = "copy";
  for (RecordingRow& row : copy.rows) {
    row.time_s += 100.0;
    row.position_m += 0.0003;
  }
  const std::vector<std::string> parts = {"copy: ", "1000 rows from 0 s", "train from 0 s", "; "};
  EXPECT_TRUE(test::has_parts(split({train}, {copy}), parts));
  EXPECT_TRUE(test::has_parts(split({copy, train}, {}), {"train: ", "copy from 0 s"}))
      << "without a test they test each other";
}

TEST(Leakage, AStretchOfTheTrainingInATestIsFoundWhereverItLies) {
  const Recording train = noisy("train");
  Recording test = noisy("test");
  // A shared stretch of 2 kLeakRows - 1 rows or more is always found, a shorter one not always.
  for (std::size_t i = 0; i < 2 * kLeakRows; ++i) test.rows[777 + i].force_N = train.rows[331 + i].force_N;
  const SharedStretch stretch = shared_stretch(train, test);
  EXPECT_EQ(stretch.rows, 2 * kLeakRows);
  EXPECT_EQ(stretch.first_row, 777u);
  EXPECT_EQ(stretch.trained_row, 331u);
  EXPECT_TRUE(palpate::test::has_parts(split({train}, {test}), {"100 rows from 0.777 s", "0.331 s"}));
}

// Twelve errors with a mean plus deviation of 0.8 and a maximum of 1.5.
Moments errors(double scale) {
  Moments moments;
  for (int i = 0; i < 11; ++i) moments.add(0.409 * scale);
  moments.add(1.5 * scale);
  return moments;
}

constexpr double kForces_N[] = {0.2, 1.0, 4.0};

// Sets the errors to these multiples of the JND at the three forces.
void set_errors(PaperModel& model, const std::array<double, 3>& scales) {
  model.errors.bins.assign(3, {});
  for (std::size_t i = 0; i < 3; ++i) {
    model.errors.bins[i].force_N.add(kForces_N[i]);
    model.errors.bins[i].error_N = errors(scales[i] * JndLine{}.at(kForces_N[i]));
  }
}

// Errors and times as in the paper: random has 0.8 JND, kD-tree a tenth less and least at large forces.
PaperData example() {
  PaperData data;
  PaperRun run{"silicone", false, {0.17, 1.27}, 41499, 45272, 6850};
  const std::pair<const char*, std::array<double, 3>> models[] = {{"grid", {0.72, 0.72, 0.72}},
                                                                  {"random", {1.0, 1.0, 1.0}},
                                                                  {"kD-tree", {0.9, 0.9, 0.7}},
                                                                  {"greedy-20", {0.75, 0.75, 0.75}},
                                                                  {"greedy-100", {0.74, 0.74, 0.74}}};
  for (const auto& [name, scales] : models)
    set_errors(run.models.emplace_back(PaperModel{name, 0, 1.0, {}, {}}), scales);
  run.exchanged = run.models;
  run.repeated = {run.models[kGreedy100]};
  run.settings = {run.models[kTreeCentres]};
  data.runs = {run};
  data.by_sites = {{500, {9.0, 0.9, 1.8, 3.6, 7.2}, 7.0},
                   {1000, {9.0, 1.0, 2.0, 4.0, 8.0}, 8.0},
                   {2000, {70.0, 2.0, 4.0, 8.0, 16.0}, 64.0}};
  data.by_dimension = {{4, {3.2, 0.0, 0.0, 1.0}, 3.0}, {5, {7.0, 0.0, 0.0, 1.0}, 3.0}, {6, {43.0, 0.0, 0.0, 1.1}, 3.0}};
  data.by_centres = {{500, 0.25e-6}, {1000, 0.5e-6}, {2000, 1.0e-6}};
  data.points = {{0.3, 0.09, 0.0, "study"}, kPangTanDurlach};
  return data;
}

Claim claim_of(const PaperData& data, const std::string& name) {
  for (Claim& one : paper_claims(data)) {
    if (one.claim.find(name) != std::string::npos) return std::move(one);
  }
  ADD_FAILURE() << name;
  return {};
}
ClaimVerdict verdict_of(const PaperData& data, const std::string& claim) {
  const Claim found = claim_of(data, claim);
  return found.here.empty() ? ClaimVerdict::none : found.here.front().verdict;
}

TEST(PaperClaims, EqualClaimsAreReproduced) {
  for (const char* claim : {"random: at every force",
                            "random: the same with other",
                            "kD-tree: mean plus deviation",
                            "kD-tree: the same with other",
                            "greedy-20: mean",
                            "greedy-100: mean",
                            "kD-tree is more accurate",
                            "especially at large",
                            "than random and kD-tree",
                            "almost as accurate",
                            "20 and 100",
                            "repetitions",
                            "lowest maxima",
                            "the longer it takes",
                            "beats the interpolation",
                            "greedy is linear in",
                            "third power",
                            "tenfold",
                            "more than four dimensions",
                            "grow exponentially",
                            "linear in the centres"})
    EXPECT_EQ(verdict_of(example(), claim), ClaimVerdict::reproduced) << claim;
  EXPECT_EQ(verdict_of(example(), "maxima at small forces"), ClaimVerdict::different) << "they are almost equal here";
}

TEST(PaperClaims, WhatDependsOnMachineRecordingOrSubjectsIsNeverReproduced) {
  EXPECT_EQ(verdict_of(example(), "one evaluation"), ClaimVerdict::other_machine);
  EXPECT_EQ(verdict_of(example(), "time of a fit"), ClaimVerdict::other_machine);
  EXPECT_EQ(verdict_of(example(), "samples after"), ClaimVerdict::other_recording);
  EXPECT_EQ(verdict_of(example(), "relative JND"), ClaimVerdict::other_subjects);
}

// Eight seconds: a fifth of the recordings of both materials. Every model of a run is judged on the same samples; the
// exchanged ones on those of the other recording, which is a tenth shorter.
TEST(MeasurePaper, JudgesEveryModelOnTheRecordingItHasNotSeen) {
  const PaperData data = test::must(measure_paper(true, {}));
  ASSERT_EQ(data.runs.size(), 2u);
  for (const PaperRun& run : data.runs) {
    ASSERT_EQ(run.models.size(), kPaperMethods);
    ASSERT_EQ(run.exchanged.size(), kPaperMethods);
    EXPECT_EQ(run.repeated.size(), 2u);
    EXPECT_EQ(run.settings.size(), 18u) << "three kernels, two normalisations, three truncations";
    const std::uint64_t samples = run.models.front().errors.samples, others = run.exchanged.front().errors.samples;
    EXPECT_LT(others, samples);
    for (const auto* list : {&run.models, &run.repeated, &run.settings}) {
      for (const PaperModel& one : *list) EXPECT_EQ(one.errors.samples, samples) << one.name;
    }
    for (const PaperModel& one : run.exchanged) EXPECT_EQ(one.errors.samples, others) << one.name;
    for (const PaperModel& one : run.models) EXPECT_TRUE(one.time.measured) << one.name;
    EXPECT_NE(run.repeated[0].errors.rms_error_N, run.models[kGreedy100].errors.rms_error_N) << "another seed";
  }
  ASSERT_EQ(data.by_sites.size(), 3u);
  EXPECT_GT(data.by_sites[2].of, data.by_sites[1].of);
  for (const FitTimes& one : data.by_sites) EXPECT_GE(one.grid_s(), 0.0);
  EXPECT_EQ(data.by_dimension.back().of, 4u);
}

}  // namespace
}  // namespace palpate
