#include "models/training/fold_assignment.h"

#include <gtest/gtest.h>

#include <set>

namespace palpate {
namespace {

TEST(FoldAssignment, WholeRecordingsFromThreeOn) {
  FoldAssignment assignment(4, 9, 900);
  EXPECT_EQ(assignment.folds(), 4);
  for (int recording = 0; recording < 4; ++recording) {
    for (int i = 0; i < 50; ++i) EXPECT_EQ(assignment.next(recording, 2 * recording + i / 25, true), recording);
  }
}

TEST(FoldAssignment, ShortStrokesStayWhole) {
  FoldAssignment assignment(1, 20, 2000);
  EXPECT_EQ(assignment.folds(), 5);
  for (int stroke = 1; stroke <= 20; ++stroke) {
    std::set<int> folds;
    for (int i = 0; i < 100; ++i) folds.insert(assignment.next(0, stroke, true));
    EXPECT_EQ(folds.size(), 1U) << stroke;
    EXPECT_EQ(*folds.begin(), (stroke - 1) % 5);
  }
}

TEST(FoldAssignment, OneLongStrokeIsCutIntoPiecesOfEveryFold) {
  for (const bool has_unloading : {true, false}) {
    FoldAssignment assignment(1, 1, 1000, has_unloading);
    std::set<int> folds;
    int changes = 0;
    int last = 0;
    for (int i = 0; i < 1000; ++i) {
      const int fold = assignment.next(0, 1, true);
      folds.insert(fold);
      changes += fold != last ? 1 : 0;
      last = fold;
    }
    EXPECT_EQ(folds.size(), 5U);
    EXPECT_EQ(changes, has_unloading ? 9 : 47) << "10 pieces, or 48 of 21 samples";
  }
}

TEST(FoldAssignment, FreeAirDoesNotChangeTheDeal) {
  FoldAssignment with_air(1, 8, 80);
  FoldAssignment without(1, 8, 80);
  for (int stroke = 1; stroke <= 8; ++stroke) {
    for (int i = 0; i < 30; ++i) with_air.next(0, stroke, false);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(with_air.next(0, stroke, true), without.next(0, stroke, true));
  }
}

}  // namespace
}  // namespace palpate
