#include "engine/import/table_cell.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(RowTimes, AClockWithoutDatesPassesMidnight) {
  RowTimes times('.');
  EXPECT_DOUBLE_EQ(times.examine({"23:59:59.75", "23:59:59.875", "00:00:00.25"}), 0.125);
  EXPECT_TRUE(times.are_of_a_clock());
  EXPECT_EQ(times.since_first("23:59:59.75"), 0.0);
  EXPECT_EQ(times.since_first("23:59:59.875"), 0.125);
  EXPECT_EQ(times.midnights(), 0);
  EXPECT_EQ(times.since_first("00:00:00.25"), 0.5);
  EXPECT_EQ(times.midnights(), 1);
  EXPECT_EQ(times.since_first("00:00:00.125"), 0.375) << "goes back";
}

TEST(RowTimes, ADateThatGoesBackIsNoMidnight) {
  RowTimes times('.');
  times.examine({"2024-03-05 23:59:59"});
  EXPECT_TRUE(times.have_dates());
  times.since_first("2024-03-05 23:59:59");
  EXPECT_EQ(times.since_first("2024-03-05 00:00:01"), -86398.0);
}

// Nanoseconds since 1970 have more digits than a double.
TEST(RowTimes, LargeNumbersKeepTheirDigits) {
  RowTimes times(',');
  EXPECT_DOUBLE_EQ(times.examine({"1700000000000000000", "1700000000001000000", "1700000000002000000,0"}), 1e6);
  EXPECT_FALSE(times.are_of_a_clock());
  EXPECT_EQ(times.since_first("1700000000000000000"), 0.0);
  EXPECT_EQ(times.since_first("1700000000000000001"), 1.0);
}

}  // namespace
}  // namespace palpate
