// A bridge device whose clock differs from the host's, in simulated time, for several sample rates, drifts and events.
#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/simulated_device.h"

namespace palpate {
namespace {

using test::Report;
using test::SimulatedDevice;

struct Event {
  const char* name;
  void (*begin)(SimulatedDevice&);
  double lasts_s;
  bool ends;  // the line is as before afterwards
  // Of the mean force before, that is left afterwards. With more lag it is smaller on purpose.
  double least_share = 0.98, most_share = 1.02;
};

void later_by_15_ms(SimulatedDevice& simulated) {
  auto queue = std::make_shared<std::deque<std::pair<double, Report>>>();
  simulated.on_the_way_in = [queue, &simulated](const Report& report) {
    queue->emplace_back(simulated.now_s + 0.015, report);
    std::vector<Report> due;
    for (; !queue->empty() && queue->front().first <= simulated.now_s; queue->pop_front()) {
      due.push_back(queue->front().second);
    }
    return due;
  };
}

void silence(SimulatedDevice& simulated) { simulated.on_the_way_in = test::lost; }

constexpr Event kEvents[] = {
    {"nothing", [](SimulatedDevice&) {}, 0.0, false},
    {"15 ms later from now on", later_by_15_ms, 0.0, false, 0.12, 0.5},
    {"clock set back by 10 ms", [](SimulatedDevice& s) { s.board().clock_offset_us -= 10'000; }, 0.0, false},
    {"clock set forward by 10 ms", [](SimulatedDevice& s) { s.board().clock_offset_us += 10'000; }, 0.0, false,
     0.4},  // it looks like a force that is older
    {"silent for 1 s", silence, 1.0, true},
    {"silent for 10 s", silence, 10.0, true},
};

// During the event, and for this time after it, the force may be zero: 100 ms until the old stream is abandoned, 50 ms
// until the new clock is identified, and 100 ms that a fault lasts.
constexpr double kRecovery_s = 0.3;
constexpr double kWatched_s = 2.5;

TEST(BridgeClock, NeitherDriftNorDelayCostsTheForceForLong) {
  for (const std::uint32_t period_us : {10'000u, 3'333u, 1'000u, 100u}) {
    for (const double drift : {-0.01, -150e-6, 0.0, 0.01}) {
      for (const Event& event : kEvents) {
        SimulatedDevice simulated(&kBridgeProtocol);
        simulated.step_us = period_us < 250 ? 100 : 250;
        simulated.board().period_us = period_us;
        simulated.board().clock_drift = drift;
        simulated.rest = false;
        simulated.run_s(1.0);
        double mean_N = 0.0;
        const auto without_ms = [&](double seconds) {
          const int count = static_cast<int>(1e3 * seconds);
          int ticks = 0;
          mean_N = 0.0;
          for (int i = 0; i < count; ++i) {
            ticks += simulated.tick().rendered_N == 0.0 ? 1 : 0;
            mean_N += simulated.snapshot.rendered_N / count;
          }
          return ticks;
        };
        const int before = without_ms(1.0);
        const double before_N = mean_N;
        event.begin(simulated);
        simulated.run_s(event.lasts_s);
        if (event.ends) simulated.on_the_way_in = nullptr;
        simulated.run_s(kRecovery_s);
        const int after = without_ms(kWatched_s);
        SCOPED_TRACE(std::to_string(1'000'000 / period_us) + " Hz, " + std::to_string(1e6 * drift) + " ppm, " +
                     event.name);
        EXPECT_EQ(before, 0) << "ms without force after 1 s";
        EXPECT_EQ(after, 0) << "ms without force after recovery";
        EXPECT_EQ(simulated.snapshot.device.faults, 0u);
        EXPECT_GE(mean_N, event.least_share * before_N);
        EXPECT_LE(mean_N, event.most_share * before_N);
        EXPECT_NEAR(simulated.motor_N(), simulated.spring_N(simulated.position_m()), 0.15);
      }
    }
  }
}

}  // namespace
}  // namespace palpate
