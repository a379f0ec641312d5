// The reference firmware and the host in ten minutes of simulated time.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "engine/base/random_stream.h"
#include "tests/support/simulated_device.h"

namespace palpate {
namespace {

using test::Report;
using test::SimulatedDevice;

// Reports are lost and corrupted in both directions and reordered from the device; both
// lines stall and the device restarts. The motor must never get a force outside the range
// of the model, a force step, or a force computed from old data.
TEST(BridgeFirmwareAndHost, TenMinutesOfTroubleAndNoUnsafeForce) {
  SimulatedDevice simulated(&kBridgeProtocol);
  RandomStream random(1, 0);
  int restarts = 0;
  int silent_in = 0, silent_out = 0;
  Report waiting;
  const auto trouble = [&](double share) { return random.uniform(0.0, 1.0) < share; };
  simulated.on_the_way_in = [&](const Report& report) {
    if (silent_in > 0) --silent_in;
    if (silent_in > 0 || trouble(0.02)) return std::vector<Report>{};
    std::vector<Report> some = {report};
    if (trouble(0.0003)) {
      some[0][random.index(some[0].size())] ^= static_cast<std::uint8_t>(1 + random.index(255));
    }
    if (!waiting.empty()) some.push_back(std::exchange(waiting, {}));
    if (trouble(0.0003)) {
      waiting = std::exchange(some[0], some.back());
      some.pop_back();
    }
    return some;
  };
  simulated.on_the_way_out = [&](Report& report) {
    if (silent_out > 0) --silent_out;
    if (silent_out > 0 || trouble(0.02)) return false;
    if (trouble(0.001)) report[random.index(report.size())] ^= static_cast<std::uint8_t>(1 + random.index(255));
    return true;
  };
  simulated.press();
  double last_N = simulated.snapshot.rendered_N, pushed_s = 0.0, age_of_push_s = 0.0;
  for (int tick = 0; tick < 600'000; ++tick) {
    if (trouble(0.0001)) silent_in = static_cast<int>(random.index(100));
    if (trouble(0.0001)) silent_out = static_cast<int>(random.index(100));
    if (trouble(0.00001)) simulated.model->restart(), ++restarts;
    const LoopSnapshot& snapshot = simulated.tick();
    const double motor_N = simulated.motor_N();
    ASSERT_TRUE(std::isfinite(motor_N));
    ASSERT_LE(motor_N, SimulatedDevice::kStiffness_N_per_m * 6.3e-3) << tick;
    ASSERT_LE(std::abs(snapshot.rendered_N - last_N), 0.45) << tick;
    last_N = snapshot.rendered_N;
    if (snapshot.device.sample_age_s <= 0.008) age_of_push_s = simulated.now_s;
    // The host sets the force to zero within 20 ms; a device without host within 50 ms more.
    ASSERT_TRUE(snapshot.rendered_N == 0.0 || simulated.now_s - age_of_push_s <= 0.0205) << tick;
    ASSERT_TRUE(motor_N == 0.0 || simulated.now_s - age_of_push_s <= 0.0755) << tick;
    if (motor_N > 0.5) pushed_s += 1e-3;
  }
  EXPECT_GT(restarts, 0);
  EXPECT_GT(pushed_s, 60.0) << "or nothing was shown";
}

}  // namespace
}  // namespace palpate
