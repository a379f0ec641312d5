#include "scenes/hard/hard_table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

// The table of `palpate hard`, in one run: every method on every hard case.
TEST(HardCases, EveryCellIsAsExpected) {
  const auto rows = run_hard();
  ASSERT_TRUE(rows.ok()) << rows.error().message;
  for (const std::string& missed : missed_cells(*rows)) ADD_FAILURE() << missed;
  // A table of refusals would be no test.
  std::size_t fitted = 0, cells = 0;
  for (const HardRow& row : *rows) {
    for (const HardCell& cell : row.cells) {
      ++cells;
      fitted += cell.refusal.empty() ? 1 : 0;
      EXPECT_EQ(cell.refusal.empty(), std::isfinite(cell.figures.worst_step_N)) << row.of.name;
    }
  }
  EXPECT_GE(fitted, 9 * cells / 10);
}

TEST(HardCases, WhatACellMissesIsNamed) {
  HardCell cell;
  cell.figures = {0.9, 0.2, 0.01, 1e-5};
  EXPECT_EQ(missed_by(cell, {}), "");
  EXPECT_EQ(missed_by(cell, {.within_jnd = 0.9, .worst_error_N = 0.2, .worst_step_N = 0.01, .energy_J = 1e-5}), "");
  EXPECT_EQ(missed_by(cell, {.within_jnd = 0.91}), "90.0 % within the JND, expected at least 91.0 %");
  EXPECT_EQ(missed_by(cell, {.worst_error_N = 0.1}), "an error of 0.200 N, expected at most 0.100 N");
  EXPECT_EQ(missed_by(cell, {.worst_step_N = 0.001}), "a step of 0.0100 N, expected at most 0.00100 N");
  EXPECT_EQ(missed_by(cell, {.energy_J = 1e-6}), "energy of 0.0100 mJ, expected at most 0.00100 mJ");
  EXPECT_EQ(missed_by(cell, {.refusal = "no sample"}), "fitted, expected a refusal");
  cell.refusal = "no sample in contact";
  EXPECT_EQ(missed_by(cell, {.refusal = "no sample"}), "");
  EXPECT_EQ(missed_by(cell, {}), "refused, expected a fit");
  EXPECT_NE(missed_by(cell, {.refusal = "too many"}), "");
}

TEST(HardCases, AForceThatIsNotFiniteIsNeverAsExpected) {
  HardMeasure measured;
  measured.add(1.0, 1.0, true, 0.0);
  measured.add(std::nan(""), 1.0, true, 1e-3);
  const HardFigures figures = measured.figures();
  EXPECT_EQ(figures.within_jnd, 0.5);
  EXPECT_EQ(figures.worst_error_N, HardExpectation::kAny);
  EXPECT_EQ(figures.worst_step_N, HardExpectation::kAny);
}

// A spring that pushes half as hard on the way in gives out half of its energy.
TEST(HardCases, EnergyIsThatBeyondTheMaterial) {
  HardMeasure measured;
  const auto spring = [](double position_m) { return 1000.0 * position_m; };
  for (int i = 0; i <= 10; ++i) measured.add(0.5 * spring(1e-4 * i), spring(1e-4 * i), true, 1e-4 * i);
  for (int i = 10; i >= 0; --i) measured.add(spring(1e-4 * i), spring(1e-4 * i), true, 1e-4 * i);
  EXPECT_NEAR(measured.figures().energy_J, 0.5 * 0.5e-3, 1e-9);
}

}  // namespace
}  // namespace palpate
