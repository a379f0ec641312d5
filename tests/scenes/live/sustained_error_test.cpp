#include "scenes/live/sustained_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

TEST(SustainedError, IsTheMeanOfTheLast50Milliseconds) {
  SustainedError error;
  double last = 0.0;
  for (int i = 0; i < 200; ++i) last = error.add(1e-3 * i, 2.0);
  EXPECT_NEAR(last, 2.0, 1e-12);
  for (int i = 200; i < 225; ++i) last = error.add(1e-3 * i, 0.0);
  EXPECT_NEAR(last, 1.0, 0.05) << "half of it is over";
  for (int i = 225; i < 260; ++i) last = error.add(1e-3 * i, 0.0);
  EXPECT_NEAR(last, 0.0, 1e-12);
}

TEST(SustainedError, ErrorsOfChangingSignDoNotLast) {
  SustainedError error;
  double last = 1.0;
  for (int i = 0; i < 100; ++i) last = error.add(1e-3 * i, i % 2 == 0 ? 3.0 : -3.0);
  EXPECT_LT(std::abs(last), 0.1);
  for (int i = 100; i < 200; ++i) last = error.add(1e-3 * i, -3.0);
  EXPECT_NEAR(last, -3.0, 1e-12) << "signed";
}

TEST(SustainedError, AGapBeginsAnew) {
  SustainedError error;
  for (int i = 0; i < 100; ++i) error.add(1e-3 * i, 5.0);
  EXPECT_NEAR(error.add(3.0, 0.5), 0.5, 1e-12);
  EXPECT_NEAR(error.add(1.0, 0.25), 0.25, 1e-12) << "time that starts over does too";
}

}  // namespace
}  // namespace palpate
