#include "scenes/report/paper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace palpate {
namespace {

// Twelve errors with a mean plus deviation of 0.8 and a maximum of 1.5.
Moments errors(double scale) {
  Moments moments;
  for (int i = 0; i < 11; ++i) moments.add(0.409 * scale);
  moments.add(1.5 * scale);
  return moments;
}

// Every method has errors of that many JND, and times in the paper's order.
PaperData example() {
  PaperData data;
  PaperRun run{"silicone", false, {0.17, 1.27}, 41499, 45272, 6850};
  const char* names[] = {"grid", "random", "kD-tree", "greedy-20", "greedy-100"};
  for (std::size_t i = 0; i < kPaperMethods; ++i) {
    PaperModel model{names[i], 0, 1.0, {}, {}};
    for (const double force_N : {0.2, 1.0, 4.0}) {
      ForceBin& bin = model.errors.bins.emplace_back();
      bin.force_N.add(force_N);
      bin.error_N = errors(data.jnd.at(force_N));
    }
    run.models.push_back(model);
  }
  run.exchanged = run.models;
  run.repeated = {run.models[kGreedy100]};
  data.runs = {run};
  data.by_sites = {{1000, {9.0, 1.0, 1.0, 1.0, 1.0}, 8.0}, {2000, {70.0, 2.0, 2.0, 2.0, 2.0}, 64.0}};
  data.by_dimension = {{5, 10.0, 1.0}, {6, 10.0, 10.0}};
  data.points = {{0.3, 0.09, 0.0, "study"}, kPangTanDurlach};
  return data;
}

Verdict verdict_of(const PaperData& data, const std::string& claim) {
  for (const Claim& one : paper_claims(data)) {
    if (one.claim.find(claim) != std::string::npos) return one.here.front().verdict;
  }
  ADD_FAILURE() << claim;
  return Verdict::none;
}

TEST(PaperClaims, EqualClaimsAreReproduced) {
  for (const char* claim : {"random: at every force", "random: the same with other", "kD-tree: mean plus deviation",
                            "kD-tree: the same with other", "greedy-20: mean", "greedy-100: mean", "more accurate than",
                            "especially at large", "most accurate", "almost as accurate", "20 and 100", "repetitions",
                            "the longer it takes", "beats the interpolation", "is linear in", "third power", "tenfold"})
    EXPECT_EQ(verdict_of(example(), claim), Verdict::reproduced) << claim;
  EXPECT_EQ(verdict_of(example(), "maxima at small forces"), Verdict::different) << "they are equal here";
}

TEST(PaperClaims, WhatDependsOnMachineRecordingOrSubjectsIsNeverReproduced) {
  EXPECT_EQ(verdict_of(example(), "one evaluation"), Verdict::other_machine);
  EXPECT_EQ(verdict_of(example(), "time of a fit"), Verdict::other_machine);
  EXPECT_EQ(verdict_of(example(), "samples after"), Verdict::other_recording);
  EXPECT_EQ(verdict_of(example(), "relative JND"), Verdict::other_subjects);
}

TEST(PaperClaims, AQuickRunDecidesNoRatio) {
  PaperData data = example();
  data.quick = true;
  for (const char* claim : {"more accurate than", "most accurate", "20 and 100", "is linear in", "tenfold"})
    EXPECT_EQ(verdict_of(data, claim), Verdict::undecided) << claim;
  EXPECT_EQ(verdict_of(data, "greedy-100: mean"), Verdict::reproduced);
}

// A claim fails on either side of its tolerance.
TEST(PaperClaims, ToleranceHasTwoSides) {
  for (const double solve_s : {8.0 * std::pow(2.0, 0.5), 8.0 * std::pow(2.0, 4.9)}) {
    PaperData data = example();
    data.by_sites[1].solve_s = solve_s;
    EXPECT_EQ(verdict_of(data, "third power"), Verdict::different) << solve_s;
  }
  for (const double fit_s : {1.3, 4.0}) {
    PaperData data = example();
    data.by_sites[1].seconds[kGreedy100] = fit_s;
    EXPECT_EQ(verdict_of(data, "is linear in"), Verdict::different) << fit_s;
  }
  for (const double grid_s : {5.5, 20.0}) {
    PaperData data = example();
    data.by_dimension[1].grid_s = grid_s;
    EXPECT_EQ(verdict_of(data, "tenfold"), Verdict::different) << grid_s;
  }
  for (const double scale : {0.75, 1.3}) {
    PaperData data = example();
    for (ForceBin& bin : data.runs[0].models[kGridOfAll].errors.bins)
      bin.error_N = errors(scale * data.jnd.at(bin.force_N.mean()));
    EXPECT_EQ(verdict_of(data, "almost as accurate"), Verdict::different) << scale;
  }
}

TEST(PaperClaims, OneBinAboveTheJndIsEnoughToRefuteAlways) {
  PaperData data = example();
  data.runs[0].models[kTreeCentres].errors.bins[1].error_N.add(3.0 * data.jnd.at(1.0));
  EXPECT_EQ(verdict_of(data, "kD-tree: mean plus deviation"), Verdict::different);
  EXPECT_EQ(verdict_of(data, "greedy-100: mean"), Verdict::reproduced);
}

TEST(PaperClaims, DifferencesAndBusyMachinesHaveARemark) {
  PaperData data = example();
  data.slowest_round = 3.0;
  for (const Claim& one : paper_claims(data)) {
    EXPECT_TRUE(one.here.front().verdict != Verdict::different || !one.why.empty()) << one.claim;
    if (one.claim.find("third power") != std::string::npos) {
      EXPECT_NE(one.why.find("busy"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace palpate
