#include "scenes/live/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes/evaluation/model_errors.h"

namespace palpate {
namespace {

constexpr JndLine kOneNewton{1.0, 0.0};

double p99(const StreamErrors& errors) { return errors.summary(kOneNewton).p99_error_over_jnd; }

TEST(StreamErrors, HaveTheNinetyNinthPercentile) {
  StreamErrors errors;
  EXPECT_EQ(p99(errors), 0.0);
  for (int i = 1; i <= 1000; ++i) errors.add(2e-3 * i, 0.0, kOneNewton);
  EXPECT_NEAR(p99(errors), 1.98, 0.011 * 1.98);
}

// An error of exactly 1 JND counts as within, as in the share within the JND.
TEST(StreamErrors, AreExactBesideOneJnd) {
  StreamErrors errors;
  for (int i = 0; i < 99; ++i) errors.add(1.0, 0.0, kOneNewton);
  errors.add(1.0001, 0.0, kOneNewton);
  EXPECT_EQ(p99(errors), 1.0);
  errors.add(1.0001, 0.0, kOneNewton);
  EXPECT_GT(p99(errors), 1.0);
}

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
