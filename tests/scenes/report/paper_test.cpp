#include "scenes/report/paper.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>

#include "tests/support/message_parts.h"

namespace palpate {
namespace {

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
  data.by_dimension = {{4, 3.0, 0.2, 1.0}, {5, 3.0, 4.0, 1.0}, {6, 3.0, 40.0, 1.1}};
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
  EXPECT_GT(data.by_sites[2].sites, data.by_sites[1].sites);
  for (const FitTimes& one : data.by_sites) EXPECT_GE(one.seconds[kGridOfAll], one.solve_s);
  EXPECT_EQ(data.by_dimension.back().dimensions, 4u);
}

}  // namespace
}  // namespace palpate
