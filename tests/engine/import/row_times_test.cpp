#include "engine/import/row_times.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

using Step = RowTimes::Step;

Step add(RowTimes& times, const char* field) {
  TableTime time;
  EXPECT_TRUE(times.parse(field, time)) << field;
  return times.add(time);
}

TEST(RowTimes, AClockWithoutDatesPassesMidnight) {
  RowTimes times('.');
  EXPECT_DOUBLE_EQ(times.examine({"23:59:59.75", "23:59:59.875", "00:00:00.25"}), 0.125);
  EXPECT_TRUE(times.are_of_a_clock());
  EXPECT_EQ(add(times, "23:59:59.75"), Step::later);
  EXPECT_EQ(add(times, "23:59:59.875"), Step::later);
  EXPECT_EQ(add(times, "00:00:00.25"), Step::after_midnight);
  EXPECT_DOUBLE_EQ(times.last_s(), 0.5);
  EXPECT_EQ(add(times, "00:00:00.125"), Step::backward);
  EXPECT_EQ(add(times, "00:00:00.25"), Step::repeated);
  EXPECT_DOUBLE_EQ(times.last_s(), 0.5) << "neither counts";
}

TEST(RowTimes, ADateThatGoesBackIsAnError) {
  RowTimes times('.');
  times.examine({"2024-03-05 23:59:59"});
  EXPECT_TRUE(times.have_dates());
  EXPECT_EQ(add(times, "2024-03-05 23:59:59"), Step::later);
  EXPECT_EQ(add(times, "2024-03-05 00:00:01"), Step::backward);
}

// Nanoseconds since 1970 have more digits than a double.
TEST(RowTimes, LargeNumbersKeepTheirDigits) {
  RowTimes times(',');
  EXPECT_DOUBLE_EQ(times.examine({"1700000000000000000", "1700000000001000000", "1700000000002000000,0"}), 1e6);
  EXPECT_FALSE(times.are_of_a_clock());
  times.use_unit(1e-9);
  EXPECT_EQ(add(times, "1700000000000000000"), Step::later);
  EXPECT_EQ(add(times, "1700000000000000001"), Step::later);
  EXPECT_DOUBLE_EQ(times.last_s(), 1e-9);
}

}  // namespace
}  // namespace palpate
