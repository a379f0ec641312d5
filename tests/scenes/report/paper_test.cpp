#include "scenes/report/paper.h"

#include <gtest/gtest.h>

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
  PaperRun run{"silicone", false, {0.17, 1.27}, 41499, 45272, 6850, {}};
  const char* names[] = {"grid", "random", "kD-tree", "greedy-20", "greedy-100"};
  const double fit_s[] = {50.0, 1.0, 2.0, 3.0, 4.0};
  for (std::size_t i = 0; i < kPaperMethods; ++i) {
    PaperModel model{names[i], 0, fit_s[i], {}, {}};
    for (const double force_N : {0.2, 1.0, 4.0}) {
      ForceBin& bin = model.errors.bins.emplace_back();
      bin.force_N.add(force_N);
      bin.error_N = errors(data.jnd.at(force_N));
    }
    run.models.push_back(model);
  }
  data.runs = {run};
  data.by_sites = {{1000, {1.0, 1.0, 1.0, 1.0, 1.0}}, {2000, {8.0, 2.0, 2.0, 2.0, 2.0}}};
  data.by_dimension = {{5, 10.0, 1.0}, {6, 10.0, 10.0}};
  return data;
}

bool reproduced(const PaperData& data, const std::string& claim) {
  for (const Claim& one : paper_claims(data)) {
    if (one.claim.find(claim) != std::string::npos) return one.here.front().reproduced;
  }
  ADD_FAILURE() << claim;
  return false;
}

TEST(PaperClaims, EqualClaimsAreReproduced) {
  const PaperData data = example();
  for (const char* claim : {"random: at every force", "kD-tree: mean plus deviation", "greedy-20: mean",
                            "greedy-100: mean", "greedy-100 is almost as accurate", "the maxima exceed",
                            "time of a fit", "is linear in", "third power", "tenfold"}) {
    EXPECT_TRUE(reproduced(data, claim)) << claim;
  }
  EXPECT_FALSE(reproduced(data, "maxima at small forces considerably lower")) << "they are equal here";
}

TEST(PaperClaims, OtherClaimsHaveARemark) {
  PaperData data = example();
  data.by_sites[1].seconds[kGreedy100] = 4.0;
  for (const Claim& one : paper_claims(data)) EXPECT_TRUE(one.here.front().reproduced || !one.why.empty()) << one.claim;
}

TEST(PaperClaims, OneBinAboveTheJndIsEnoughToRefuteAlways) {
  PaperData data = example();
  data.runs[0].models[kTreeCentres].errors.bins[1].error_N.add(3.0 * data.jnd.at(1.0));
  EXPECT_FALSE(reproduced(data, "kD-tree: mean plus deviation"));
  EXPECT_TRUE(reproduced(data, "greedy-100: mean"));
  data.by_sites[1].seconds[kGreedy100] = 4.0;
  EXPECT_FALSE(reproduced(data, "is linear in")) << "doubled sites, four times the time";
}

}  // namespace
}  // namespace palpate
