// The true force of the virtual material in the tick.
#include "scenes/live/comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/rt_guard.h"

namespace palpate {
namespace {

Material silicone() { return find_material("silicone").value(); }

TickSnapshot press_at(double time_s) {
  TickSnapshot snapshot;
  snapshot.time_s = time_s;
  snapshot.position_m = 4e-3 * std::sin(6.0 * time_s);
  snapshot.velocity_m_per_s = 24e-3 * std::cos(6.0 * time_s);
  return snapshot;
}

TEST(TrueForce, IsTheMaterialsUnderTheSameTool) {
  TrueForce force(silicone());
  const auto block = silicone().make_block();
  block->reset(0.0);
  EXPECT_EQ(force.step(press_at(0.0), false), 0.0);
  double time_s = 0.0;
  for (int i = 1; i < 2000; ++i) {
    const double step_s = i % 3 == 0 ? 2.5e-3 : 1e-3;  // uneven time steps
    const double next_s = time_s + step_s;
    const TickSnapshot snapshot = press_at(next_s);
    ASSERT_EQ(force.step(snapshot, false),
              block->step(snapshot.position_m, snapshot.velocity_m_per_s, next_s - time_s));
    time_s = next_s;
  }
}

TEST(TrueForce, IsFitForTheTick) {
  if (!test::rt_guard_works()) GTEST_SKIP() << "the sanitizer owns malloc";
  TrueForce force(silicone());
  test::RtGuard guard;
  double sum_N = 0.0;
  for (int i = 0; i < 10000; ++i) sum_N += force.step(press_at(1e-3 * i), i % 1000 == 0);
  EXPECT_EQ(guard.stop().total(), 0);
  EXPECT_GT(sum_N, 0.0);
}

}  // namespace
}  // namespace palpate
