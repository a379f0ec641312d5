// The memory of features: relaxation times that depend on depth, and the memory kept in an exchange of models
// (engine/tick/features.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/tick/features.h"
#include "tests/support/feature_specs.h"

namespace palpate {
namespace {

using namespace test;

// The same motion relative to a surface at half a millimetre gives the same features.
TEST(FeatureMemory, ASurfaceDeeperThanZeroOnlyMovesTheZero) {
  std::vector<FeatureSpec> specs = {FeatureSpec{},
                                    {FeatureKind::velocity},
                                    creep({2.0}, stiffening()),
                                    spectrum({0.3}, stiffening()),
                                    stops({1e-4}, stiffening())};
  FeatureFilter plain(specs);
  specs[0].surface_position_m = 0.5e-3;
  FeatureFilter moved(specs);
  for (int i = 0; i < 5000; ++i) {
    const double position_m = closed_motion_m(1e-3 * i) - 3e-3;
    const FeatureVector& a = feed(plain, 1e-3 * i, position_m, 0.01);
    const FeatureVector& b = feed(moved, 1e-3 * i, position_m + 0.5e-3, 0.01);
    ASSERT_EQ(a.in_contact, b.in_contact);
    // Positions differ by rounding, 1e-19 m at some N/mm.
    for (std::size_t k = 0; k < specs.size(); ++k) ASSERT_NEAR(a.values[k], b.values[k], 1e-12) << k;
  }
}

// A complete material. Energy returned in a cycle may have been stored in an earlier one, so the sum over all cycles
// from rest must be positive.
TEST(FeatureMemory, TimesThatSlowMakeNoEnergy) {
  const DriveCurve elastic{5e-3, {0.5, 0.4}};
  for (const double slowing : {0.0, 3.0, -2.0}) {
    for (const double duration_s : {0.05, 0.5, 5.0}) {
      FeatureSpec branches = spectrum({0.01, 0.1, 1.0}, stiffening());
      branches.slowing = slowing;
      FeatureFilter filter({branches});
      double before_N = 0.0;
      double work = 0.0;
      constexpr int kSteps = 20000;
      feed(filter, 0.0, closed_motion_m(0.0));
      for (int i = 1; i <= 4 * kSteps; ++i) {
        const double phase = static_cast<double>(i) / kSteps;
        const double position_m = closed_motion_m(phase);
        const double force_N = elastic.at(position_m) + feed(filter, duration_s * phase, position_m).values[0];
        work += 0.5 * (force_N + before_N) * (position_m - closed_motion_m(phase - 1.0 / kSteps));
        before_N = force_N;
      }
      EXPECT_GT(work, 0.0) << slowing << " " << duration_s;
    }
  }
}

// After an exchange of models in mid-press, the memory of equal features continues.
TEST(FeatureMemory, AnotherFilterAdoptsTheMemoryOfTheSameFeatures) {
  const DriveCurve softer{5e-3, {0.2, 0.1, 0.0, 0.0}};
  const std::vector<FeatureSpec> specs = {spectrum({0.3}, stiffening()), stops({3e-4, 1e-4}, stiffening()),
                                          creep({2.0}, stiffening()), spectrum({0.3}, softer)};
  FeatureFilter before({FeatureSpec{}, stops({5e-4}, softer), specs[1], specs[2], specs[0]});
  FeatureFilter always(specs);
  const auto at = [](int i) { return closed_motion_m(2e-4 * i); };
  for (int i = 0; i < 2000; ++i) {
    feed(before, 1e-3 * i, at(i));
    feed(always, 1e-3 * i, at(i));
  }
  FeatureFilter after(specs);
  feed(after, 1.999, at(1999));
  after.adopt(before);
  EXPECT_EQ(after.vector().values[3], 0.0) << "a branch of no earlier model is at rest";
  for (int i = 2000; i < 4000; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(after.vector().values[k], always.vector().values[k]) << feature_name(specs[k]);
    }
    feed(after, 1e-3 * i, at(i));
    feed(always, 1e-3 * i, at(i));
  }
  EXPECT_NEAR(after.vector().values[3], always.vector().values[3], 0.01 * std::abs(always.vector().values[0]))
      << "after seven times its relaxation time";
}

// An excursion beyond the training domain is remembered as one to its edge, by every feature; the depth itself is not
// changed.
TEST(FeatureMemory, KeepsNoDepthBeyondTheDomain) {
  constexpr double kDeepest_m = 4e-3;
  FeatureSpec slowed = spectrum({0.05, 0.8}, stiffening());
  slowed.slowing = 1.5;
  const std::vector<FeatureSpec> specs = {FeatureSpec{}, lowpass(0.17), slowed, stops({0.1e-3, 1e-3}, stiffening()),
                                          creep({2.0}, stiffening())};
  for (const double beyond_m : {4.1e-3, 8e-3, 0.5, 1e3}) {
    FeatureFilter far(specs, kDeepest_m), edge(specs, kDeepest_m), free(specs);
    bool differs = false;
    for (int i = 0; i < 1000; ++i) {
      const double position_m = 3e-3 * std::sin(0.02 * i);
      const bool out = i > 200 && i % 97 < 5;
      feed(far, 1e-3 * i, out ? beyond_m : position_m);
      feed(edge, 1e-3 * i, out ? kDeepest_m : position_m);
      feed(free, 1e-3 * i, out ? beyond_m : position_m);
      ASSERT_EQ(far.vector().values[0], out ? beyond_m : std::max(0.0, position_m));
      for (std::size_t k = 1; k < specs.size(); ++k) ASSERT_EQ(far.vector().values[k], edge.vector().values[k]) << k;
      differs = differs || free.vector().values != far.vector().values;
    }
    EXPECT_TRUE(differs);
  }
}

}  // namespace
}  // namespace palpate
