#include <gtest/gtest.h>

#include <cmath>

#include "scenes/hard/hard.h"

namespace palpate {
namespace {

// The table of `palpate hard`, in one run: every method on every hard case.
TEST(HardCases, EveryCellIsAsExpectedAndTheControlFails) {
  const auto rows = run_hard();
  ASSERT_TRUE(rows.ok()) << rows.error().message;
  for (const std::string& missed : missed_cells(*rows)) ADD_FAILURE() << missed;
  // A table of refusals would be no test, and a table that nothing fails would be none.
  std::size_t fitted = 0, cells = 0, unstable = 0;
  for (const HardRow& row : *rows) {
    ASSERT_EQ(row.cells.size(), hard_methods().size());
    unstable += (row.cells.back().breaks & kBreaksStep) != 0 ? 1 : 0;
    for (const HardCell& cell : row.cells) {
      ++cells;
      fitted += cell.refusal.empty() ? 1 : 0;
      EXPECT_EQ(cell.refusal.empty(), std::isfinite(cell.figures.worst_step_N)) << row.of.name;
    }
  }
  EXPECT_GE(fitted, 9 * cells / 10);
  EXPECT_GE(unstable, 5u) << "of the negative control";
}

TEST(HardCases, OnlyANewBreakOfARecordedMethodIsUnexpected) {
  HardCase one;
  one.breaks = {{"voxel", kBreaksError}};
  HardCell cell;
  cell.breaks = kBreaksError;
  EXPECT_EQ(missed_by(cell, one, "voxel"), "");
  cell.breaks = kBreaksError | kBreaksStep | kBreaksEnergy;
  EXPECT_EQ(missed_by(cell, one, "voxel"), "breaks step, energy");
  EXPECT_EQ(missed_by(cell, one, "a stranger's"), "");
  cell.figures.worst_step_N = std::numeric_limits<double>::infinity();
  EXPECT_EQ(missed_by(cell, one, "a stranger's"), "a force that is not finite");
  cell.refusal = "no sample in contact";
  EXPECT_EQ(missed_by(cell, one, "voxel"), "refused, expected a fit");
  one.refusal = "no sample";
  EXPECT_EQ(missed_by(cell, one, "voxel"), "");
  cell.refusal = "too many";
  EXPECT_NE(missed_by(cell, one, "voxel"), "");
  EXPECT_EQ(missed_by({}, one, "voxel"), "fitted, expected a refusal");
}

TEST(HardCases, AForceThatIsNotFiniteBreaksErrorAndStep) {
  HardMeasure measured;
  measured.add(1.0, 1.0, true, 0.0);
  measured.add(std::nan(""), 1.0, true, 1e-3);
  const HardFigures figures = measured.figures();
  EXPECT_EQ(figures.within_jnd, 0.5);
  EXPECT_TRUE(std::isinf(figures.worst_error_N) && std::isinf(figures.worst_step_N));
  EXPECT_EQ(figures.breaks(true) & (kBreaksError | kBreaksStep), kBreaksError | kBreaksStep);
  EXPECT_EQ(figures.breaks(false) & kBreaksError, 0u) << "where the force cannot be known";
}

// One JND at 1 N is 0.128 N, and the true force steps by 0.1 N.
TEST(HardCases, AStepMayBeThatOfTheTruthAndOneJnd) {
  for (const auto& [step_N, breaks] : {std::pair{0.22, 0U}, {0.24, static_cast<unsigned>(kBreaksStep)}}) {
    HardMeasure measured;
    measured.add(0.9, 0.9, true);
    measured.add(1.0, 1.0, true);
    measured.add(1.0 + step_N, 1.0, true);
    EXPECT_EQ(measured.figures().breaks(false), breaks) << step_N;
  }
}

// A spring that pushes half as hard on the way in gives out half of its energy; where it turns, its force steps.
TEST(HardCases, EnergyIsThatBeyondTheMaterial) {
  HardMeasure measured;
  const auto spring = [](double position_m) { return 1000.0 * position_m; };
  for (int i = 0; i <= 10; ++i) measured.add(0.5 * spring(1e-4 * i), spring(1e-4 * i), true, 1e-4 * i);
  for (int i = 10; i >= 0; --i) measured.add(spring(1e-4 * i), spring(1e-4 * i), true, 1e-4 * i);
  EXPECT_NEAR(measured.figures().energy_J, 0.5 * 0.5e-3, 1e-9);
  EXPECT_EQ(measured.figures().breaks(false), kBreaksStep | kBreaksEnergy);
}

}  // namespace
}  // namespace palpate
