#include "models/training/relaxation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/random_points.h"

namespace palpate {
namespace {

double smooth(double share) {
  const double t = std::clamp(share, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// A spring of 200 N/m beside a Maxwell branch of 300 N/m and `time_s`, pressed
// and held, measured with 5 mN of noise, without which any further time
// would still improve the fit. For a piecewise linear depth the branch's force is the
// closed form z' = e z + k tau (1 - e) v, exact at every sample.
Recording press_and_hold(double time_s, int strokes) {
  constexpr double kStep_s = 2e-3;
  Recording recording;
  recording.name = "holds";
  test::Numbers noise(1);
  double branch_N = 0.0;
  double last_m = -1e-3;
  for (int i = 0; i < strokes * 1500; ++i) {
    const int stroke = i / 1500;
    const double t = kStep_s * (i % 1500);
    const double depth_m = 3e-3 + 1e-3 * (stroke % 3);
    const double speed_m_per_s = 0.01 + 0.02 * (stroke % 4);
    // Down in smooth strokes of many speeds, held to 2.2 s, then up: a hand makes
    // no corners, and none are asked of the motion estimator.
    const double down = smooth(t * speed_m_per_s / depth_m);
    const double up = smooth((t - 2.2) / 0.3);
    const double position_m = -1e-3 + (depth_m + 1e-3) * (down - up);
    const double before_m = std::max(0.0, last_m);
    const double now_m = std::max(0.0, position_m);
    const double keep = std::exp(-kStep_s / time_s);
    branch_N = keep * branch_N + 300.0 * time_s * (1.0 - keep) * (now_m - before_m) / kStep_s;
    const double force_N = position_m > 0.0 ? std::max(0.0, 200.0 * now_m + branch_N + 5e-3 * noise.next()) : 0.0;
    recording.rows.push_back({kStep_s * i, position_m, force_N, 0.0, 0.0});
    last_m = position_m;
  }
  return recording;
}

Result<RelaxationIdentification> identify(const Recording& recording, const FitControl& control = {}) {
  MotionSource source({{"", std::make_shared<const Recording>(recording)}});
  return identify_relaxation(source, 5e-3, 0.02, Weighting::jnd, {}, 0.01, control);
}

TEST(Relaxation, FindsTheTimeOfAClosedFormWithinFivePercent) {
  for (const double time_s : {0.06, 0.4, 1.5}) {
    const auto identified = identify(press_and_hold(time_s, 12));
    ASSERT_TRUE(identified.ok()) << identified.error().message;
    std::string found;
    for (const IdentifiedTime& time : identified->times) found.append(std::to_string(time.time_s)).append(" s, ");
    for (const double error : identified->error_over_jnd) found.append(" ").append(std::to_string(error));
    ASSERT_EQ(identified->times.size(), 1u) << time_s << " s: " << found;
    EXPECT_NEAR(identified->times[0].time_s, time_s, 0.05 * time_s);
    EXPECT_GE(identified->times[0].standard_error_s, 0.0);
    EXPECT_LT(identified->times[0].standard_error_s, 0.1 * time_s);
    EXPECT_EQ(identified->error_over_jnd.size(), 3u);
  }
}

TEST(Relaxation, StopsWhereverItIsAsked) {
  const Recording recording = press_and_hold(0.4, 3);
  int questions = 0;
  ASSERT_TRUE(identify(recording, {[&](double) { return ++questions > 0; }}).ok());
  ASSERT_GT(questions, 0);
  for (int stop = 1; stop <= questions; ++stop) {
    int asked = 0;
    const auto identified = identify(recording, {[&](double) { return ++asked < stop; }});
    ASSERT_FALSE(identified.ok());
    EXPECT_EQ(identified.error().message, "interrupted");
  }
}

TEST(Relaxation, AsksForMoreSamples) {
  Recording recording = press_and_hold(0.4, 1);
  recording.rows.resize(120);  // the tool arrives after 50 rows
  const auto identified = identify(recording);
  ASSERT_TRUE(identified.ok()) << identified.error().message;
  recording.rows.resize(80);
  const auto short_one = identify(recording);
  ASSERT_FALSE(short_one.ok());
  const auto contact = std::count_if(recording.rows.begin(), recording.rows.end(),
                                     [](const RecordingRow& row) { return row.position_m > 0.0; });
  EXPECT_EQ(short_one.error().message, std::string("relaxation times need at least 50 samples in contact, found ")
                                           .append(std::to_string(contact))
                                           .append("; record longer, or pass --relaxation scene"));
}

TEST(Relaxation, SameRecordingSameBits) {
  const Recording recording = press_and_hold(0.17, 4);
  const auto a = identify(recording);
  const auto b = identify(recording);
  ASSERT_TRUE(a.ok() && b.ok());
  ASSERT_EQ(a->times.size(), b->times.size());
  for (std::size_t i = 0; i < a->times.size(); ++i) EXPECT_EQ(a->times[i].time_s, b->times[i].time_s);
}

}  // namespace
}  // namespace palpate
