// loop MODEL.json [SECONDS]: the loop of loop.c in C++17: a real-time thread, absolute deadlines, the measured lag.
// Replace Device by yours.
#include <sched.h>
#include <sys/mman.h>
#include <palpate/palpate.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

using Clock = std::chrono::steady_clock;
constexpr auto kPeriod = std::chrono::milliseconds(1);

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

// A finger of 100 g that goes to 3 mm, positive inside the block.
struct Device {
  static constexpr double kTransport_s = 0.0;  // from the encoder to this program, and from here to the motor
  double position_m = -1e-3, velocity_m_per_s = 0.0;

  void push(double force_N) noexcept {
    const double drive_N = 300.0 * (3e-3 - position_m) - 6.0 * velocity_m_per_s;
    velocity_m_per_s += seconds(kPeriod) * (drive_N - force_N) / 0.1;
    position_m += seconds(kPeriod) * velocity_m_per_s;
  }
};

void become_real_time() {
  sched_param priority{};
  priority.sched_priority = 80;
  if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0) std::puts("no real-time priority: the loop will jitter more");
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) std::puts("memory is not locked: a page fault may delay the loop");
}

int main(int count, char** words) try {
  const palpate::Model model(count > 1 ? words[1] : "model.json");
  palpate::Stream stream(model);
  palpate::Limiter limiter;
  Device device;
  become_real_time();
  const Clock::time_point begin = Clock::now(), end = begin + std::chrono::seconds(count > 2 ? std::atol(words[2]) : 5);
  Clock::time_point deadline = begin, before = begin - kPeriod;
  long missed = 0;
  double worst_s = 0.0;
  for (long tick = 1; deadline < end; ++tick) {
    const Clock::time_point now = Clock::now();
    const double force_N = limiter.render(stream, seconds(now - begin), device.position_m, seconds(now - before));
    device.push(force_N);
    worst_s = std::max(worst_s, Device::kTransport_s + seconds(Clock::now() - now) + 0.5 * seconds(now - before));
    before = now;
    if (tick % 500 == 0) {  // the largest of half a second, because a late force counts, not the mean
      limiter.set_lag(worst_s);
      std::printf("force %.3f N, lag %.2f ms, stiffness share %.2f, flags %u, missed %ld\n", force_N, 1e3 * worst_s,
                  limiter.stiffness_share(), limiter.flags(), missed);
      worst_s = 0.0;
    }
    deadline += kPeriod;
    if (Clock::now() > deadline) {  // too late: skip, never catch up
      deadline = Clock::now();
      ++missed;
    }
    std::this_thread::sleep_until(deadline);
  }
  device.push(0.0);
} catch (const palpate::Failure& failure) {
  std::fprintf(stderr, "error: %s\n", failure.what());
  return 1;
}
