#include "models/fit/fit.h"

#include <gtest/gtest.h>

#include "engine/base/text.h"
#include "tests/support/message_parts.h"

namespace palpate {
namespace {

using test::message_of;
using test::must;

std::vector<std::string> names_of_all() {
  std::vector<std::string> names;
  for (const ModelPlan& plan : all_plans()) names.push_back(plan_name(plan));
  return names;
}

// Every method on the measured force, the trend, and every method on its residual.
TEST(ModelPlan, HasTheNamesOfTheTableOfMethods) {
  std::vector<std::string> names, families;
  for (const std::string base : {"", "trend+"}) {
    if (!base.empty()) names.push_back("trend"), families.push_back("trend");
    for (const Method* method : methods()) {
      if (method == &kTrendMethod) continue;
      families.push_back(base + method->name);
      names.push_back(families.back() + (method->can_take(kTakesCentres) ? "-100" : ""));
    }
  }
  EXPECT_EQ(names_of_all(), names);
  EXPECT_EQ(family_names(), joined(families));
  EXPECT_EQ(family_names(kTakesGrid), "voxel, trend+voxel");
  EXPECT_EQ(family_names(kTakesCandidates), "greedy, trend+greedy");
  EXPECT_EQ(plan_name({}), "trend+greedy-100") << "the default";
}

TEST(ModelPlan, IsReadFromItsNames) {
  for (const ModelPlan& plan : all_plans()) {
    EXPECT_EQ(must(parse_plan(plan_name(plan))), plan) << plan_name(plan);
    EXPECT_EQ(must(parse_plan(family_name(plan))), plan) << family_name(plan);
  }
  for (const char* name : {"greedy-1", "greedy-40", "trend+kdtree-2000"})
    EXPECT_EQ(plan_name(must(parse_plan(name))), name);
}

TEST(ModelPlan, NamesWhatItDoesNotKnow) {
  const std::string known = ", expected one of " + family_names() + ", where a number of centres may follow: greedy-40";
  for (const char* name : {"", "nothing", "trend+", "trend+trend", "greedy+trend", "Greedy", "direct-40", "trend-40",
                           "trend+voxel-5", "-40", "position"})
    EXPECT_EQ(message_of(parse_plan(name)), "found \"" + std::string(name) + "\"" + known);
  for (const char* name : {"greedy-", "greedy-0", "greedy-2001", "greedy-4x", "trend+random-1e2"})
    EXPECT_EQ(message_of(parse_plan(name)),
              "found \"" + std::string(name) + "\", expected a number of centres of 1 to 2000");
}

TEST(ModelPlan, DefaultsFollowTheBase) {
  const ModelPlan trend = must(parse_plan("trend"));
  const ModelPlan force = must(parse_plan("greedy"));
  EXPECT_EQ(trend.thins(), Thinning::coverage);
  EXPECT_EQ(force.thins(), Thinning::force);
  ModelPlan given = force;
  given.thinning = Thinning::none;
  EXPECT_EQ(given.thins(), Thinning::none);
}

TEST(PlanOptions, AreReadInAnyOrder) {
  const ModelPlan plan =
      must(parse_plan_options(" seed=7 candidates=all centres=40   method=greedy features=depth,velocity "
                              "kernel=thin-plate "));
  EXPECT_EQ(plan_name(plan), "greedy-40");
  EXPECT_EQ(plan.candidates, 0);
  EXPECT_EQ(plan.seed, 7u);
  EXPECT_EQ(plan.kernel, KernelKind::thin_plate);
  EXPECT_EQ(plan.features, FeatureChoice::given);
  EXPECT_EQ(plan.list.features.size(), 2u);
  const ModelPlan grid = must(parse_plan_options("grid=25x11x11x11 method=trend+voxel features=scene"));
  EXPECT_EQ(grid.grid, (std::vector{25, 11, 11, 11}));
  EXPECT_EQ(grid.features, FeatureChoice::scene);
  EXPECT_EQ(must(parse_plan_options("")), ModelPlan{});
  EXPECT_EQ(must(parse_plan_options("kernel=auto features=auto")), ModelPlan{});
  EXPECT_EQ(must(parse_plan_options("seed=18446744073709551615")).seed, 18446744073709551615u);
}

TEST(PlanOptions, NameEachWrongOne) {
  const std::pair<const char*, std::string> wrong[] = {
      {"method=nothing", "method: found \"nothing\", expected one of " + family_names() +
                             ", where a number of centres may follow: greedy-40"},
      {"method=greedy-0", "method: found \"greedy-0\", expected a number of centres of 1 to 2000"},
      {"centres=2001", "centres: found \"2001\", expected 1 to 2000; direct uses every site"},
      {"centres=0", "centres: found \"0\", expected 1 to 2000; direct uses every site"},
      {"centres=", "centres: found \"\", expected 1 to 2000; direct uses every site"},
      {"candidates=0", "candidates: found \"0\", expected a whole number of at least 1, or all"},
      {"kernel=gauss", "kernel: found \"gauss\", expected auto, or one of cubic, linear, thin-plate"},
      {"method=voxel grid=1x2", "grid: found \"1x2\", expected sizes such as 25x11x11x11"},
      {"method=voxel grid=5x", "grid: found \"5x\", expected sizes such as 25x11x11x11"},
      {"method=voxel grid=2.5x3", "grid: found \"2.5x3\", expected sizes such as 25x11x11x11"},
      {"method=random seed=-1", "seed: found \"-1\", expected a whole number"},
      {"method=random seed=18446744073709551616", "seed: found \"18446744073709551616\", expected a whole number"},
      {"features=speed",
       "features: found \"speed\", expected depth, velocity, maxwell:, stops: and creep:, where only maxwell: may be "
       "repeated; or auto, or scene"},
      {"speed=1",
       "found \"speed\", expected NAME=VALUE with a name of method, centres, candidates, features, kernel, grid, "
       "seed"},
      {"method",
       "method: found \"\", expected one of " + family_names() + ", where a number of centres may follow: greedy-40"},
  };
  for (const auto& [text, message] : wrong) EXPECT_EQ(message_of(parse_plan_options(text)), message);
}

TEST(PlanOptions, RefuseThoseThatExcludeEachOther) {
  const std::pair<const char*, const char*> wrong[] = {
      {"method=greedy-40 centres=50", "centres: found \"50\", expected 40, the number in the name of the method"},
      {"method=greedy-100 centres=50", "centres: found \"50\", expected 100, the number in the name of the method"},
      {"method=greedy features=depth,stops:0.1mm",
       "features: found stops or creep, expected depth, velocity and maxwell: with a method on the measured force; use "
       "trend+greedy"},
      {"method=direct features=creep:1",
       "features: found stops or creep, expected depth, velocity and maxwell: with a method on the measured force; use "
       "trend+direct"},
  };
  for (const auto& [text, message] : wrong) EXPECT_EQ(message_of(parse_plan_options(text)), message);
  // These agree.
  EXPECT_EQ(plan_name(must(parse_plan_options("method=greedy-40 centres=40"))), "greedy-40");
  EXPECT_TRUE(parse_plan_options("method=trend features=depth,stops:0.1mm").ok());
}

TEST(PlanOptions, RefuseWhatTheMethodDoesNotTake) {
  const std::string centres = "random, kdtree, greedy, trend+random, trend+kdtree, trend+greedy";
  const std::pair<const char*, std::string> wrong[] = {
      {"method=direct centres=5", "centres: direct does not take this option, only " + centres + "; leave it out"},
      {"centres=5 method=trend", "centres: trend does not take this option, only " + centres + "; leave it out"},
      {"method=kdtree candidates=5",
       "candidates: kdtree does not take this option, only greedy, trend+greedy; leave it out"},
      {"grid=5x5", "grid: trend+greedy does not take this option, only voxel, trend+voxel; leave it out"},
      {"method=trend kernel=cubic",
       "kernel: trend does not take this option, only direct, voxel, random, kdtree, greedy, trend+direct, "
       "trend+voxel, trend+random, trend+kdtree, trend+greedy; leave it out"},
      {"method=direct seed=3",
       "seed: direct does not take this option, only random, kdtree, greedy, trend+random, trend+kdtree, "
       "trend+greedy; leave it out"},
  };
  for (const auto& [text, message] : wrong) EXPECT_EQ(message_of(parse_plan_options(text)), message);
}

TEST(FeatureListText, SaysWhatIsWrong) {
  for (const char* text :
       {"", "depth,", "speed", "velocity,velocity", "depth,depth", "maxwell", "maxwell:", "maxwell:-1", "maxwell:0.1+",
        "stops:0.1", "stops:0mm", "creep:", "creep:nan", "maxwell:1e999"})
    EXPECT_TRUE(test::has_parts(parse_feature_list(text), {"found \"", "expected "})) << text;
  EXPECT_EQ(
      message_of(parse_feature_list("velocity,maxwell:1,maxwell:2,maxwell:3,maxwell:4,maxwell:5,maxwell:6,creep:1")),
      "found 9 features, expected at most 8; join relaxation times with +");
}

}  // namespace
}  // namespace palpate
