#include "tests/stability/hard_cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <iostream>

namespace palpate {
namespace {

// Logs one line for each case and method.
void print(const HardCaseResult& r) {
  std::cout << std::left << std::setw(44) << r.name << std::setw(8) << r.method << std::scientific
            << std::setprecision(1) << r.condition << "  " << r.residual << "  " << r.smoothing << std::defaultfloat
            << "  " << (r.safe ? "" : "UNSAFE ") << r.outcome << "\n";
}

void expect_safe(const std::vector<HardCaseResult>& results) {
  for (const HardCaseResult& r : results) {
    print(r);
    EXPECT_TRUE(r.safe) << r.name << ", " << r.method << ": " << r.outcome;
    EXPECT_TRUE(std::isfinite(r.condition) && std::isfinite(r.residual) && std::isfinite(r.smoothing)) << r.name;
  }
}

TEST(HardCases, EveryMethodIsSafeWithEverySetOfSites) { expect_safe(run_hard_sites()); }

// Common faults of a rig must not reduce accuracy.
TEST(HardCases, EveryMethodIsSafeWithEveryRecording) {
  const std::vector<HardCaseResult> results = run_hard_recordings(FeatureChoice::scene);
  expect_safe(results);
  for (const HardCaseResult& r : results) {
    for (const char* name : {"nothing wrong", "one outlier of 100 N", "20 % noise", "dropped samples", "10 Hz",
                             "jittered time stamps", "never leaves the surface", "forces near zero, weights 1/f"})
      if (r.name == name) {
        EXPECT_GE(r.within_jnd, 0.999) << r.name << ", " << r.method;
      }
  }
}

TEST(HardCases, EveryMethodIsSafeWithEveryRecordingThatDecidesItsFeatures) {
  expect_safe(run_hard_recordings(FeatureChoice::automatic));
}

// Materials with friction, softening, layers and fluids, with automatically selected features.
TEST(HardCases, EveryMethodIsSafeInEveryMaterial) { expect_safe(run_hard_materials()); }

TEST(HardCases, EveryMethodIsSafeOnEveryMotion) { expect_safe(run_hard_motions()); }

}  // namespace
}  // namespace palpate
