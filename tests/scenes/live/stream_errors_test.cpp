#include "scenes/live/comparison.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(StreamErrors, AreThoseOfAllSamples) {
  const JndLine jnd;
  StreamErrors stream;
  ModelErrors all(jnd);
  all.begin_stroke();
  for (int i = 0; i < 1000; ++i) {
    const double model_N = 1.0 + 5e-4 * i * std::sin(0.1 * i);
    stream.add(model_N, 1.0, jnd);
    all.add(model_N, 1.0, false);
  }
  const ErrorSummary errors = stream.summary(jnd), exact = all.summary();
  EXPECT_EQ(errors.samples, 1000u);
  EXPECT_EQ(errors.within_jnd, exact.within_jnd);
  EXPECT_NEAR(errors.p99_error_over_jnd, exact.p99_error_over_jnd, 0.011 * exact.p99_error_over_jnd);
}

TEST(SustainedError, IsTheSignedMeanOfTheLast50Milliseconds) {
  SustainedError error;
  double last = 0.0;
  for (int i = 0; i < 200; ++i) last = error.add(1e-3 * i, -2.0);
  EXPECT_NEAR(last, -2.0, 1e-12);
  for (int i = 200; i < 225; ++i) last = error.add(1e-3 * i, 0.0);
  EXPECT_NEAR(last, -1.0, 0.05) << "half of it is over";
  for (int i = 225; i < 300; ++i) last = error.add(1e-3 * i, i % 2 == 0 ? 3.0 : -3.0);
  EXPECT_LT(std::abs(last), 0.1) << "changing signs do not last";
  EXPECT_NEAR(error.add(3.0, 0.5), 0.5, 1e-12) << "a gap restarts the window";
  EXPECT_NEAR(error.add(1.0, 0.25), 0.25, 1e-12) << "so does a time that starts over";
  for (int i = 0; i < 5000; ++i) last = error.add(1.0, i < 4000 ? 1.0 : 0.0);
  EXPECT_NEAR(last, 0.0, 1e-12) << "a time that stands still: the newest thousand samples";
}

}  // namespace
}  // namespace palpate
