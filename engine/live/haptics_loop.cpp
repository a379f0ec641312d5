#include "engine/live/haptics_loop.h"

#include <future>
#include <system_error>
#include <utility>

#include "engine/base/files.h"
#include "engine/base/text.h"

namespace palpate {
namespace {

constexpr double kSPerNs = 1e-9;
constexpr auto kPeriod_ns = static_cast<std::int64_t>(1e9 * kHapticTick_s);
// At the end the limiter reduces the force to 0, as when a dead-man key is released. This is enough for its longest
// sensible stop; then 0 is written to the device in any case.
constexpr int kLetGoTicks = 100;
constexpr LoopControls kReleased{.dead_man = DeadMan::key};

double seconds(std::int64_t time_ns) noexcept { return kSPerNs * static_cast<double>(time_ns); }

}  // namespace

HapticsLoop::HapticsLoop(Device& device, const LoopSettings& settings)
    : device_(device),
      settings_(settings),
      live_(device, slot_, settings),
      ring_(std::make_unique<SpscRing<LoopSnapshot, kSnapshotRing>>()) {}

Status HapticsLoop::start() {
  std::promise<RtStatus> granted;
  std::future<RtStatus> answer = granted.get_future();
  stop_.store(false, std::memory_order_relaxed);
  try {
    thread_ = std::thread([this, granted = std::move(granted)]() mutable {
      RtStatus status;
      if (settings_.realtime) {
        status = make_this_thread_realtime();
      } else {
        status.scheduling = "normal, as requested";
        set_timer_slack_1ns();
      }
      granted.set_value(std::move(status));
      run(pacer_);
    });
  } catch (const std::system_error& error) {
    return Error{std::string("cannot start the haptics thread: ") + error.what() + "; close other programs"};
  }
  scheduling_ = answer.get();
  return {};
}

void HapticsLoop::stop() {
  request_stop();
  if (thread_.joinable()) thread_.join();
}

void HapticsLoop::run(Pacer& pacer) noexcept {
  live_.warm_up();
  last_tick_ns_.store(pacer.now_ns(), std::memory_order_relaxed);
  Deadlines deadlines(pacer.now_ns(), kPeriod_ns);
  while (!stop_.load(std::memory_order_relaxed)) {
    wait_for(pacer, deadlines.next_ns());
    const std::int64_t woke_ns = pacer.now_ns();
    tick(pacer, deadlines.wake(woke_ns), woke_ns);
  }
  let_go(pacer, deadlines);
}

// Rehearses the tick after waking up, when all caches are cold, and once more shortly before the deadline, because
// other threads use the caches of this core in between. It does not rehearse if that could delay the tick.
void HapticsLoop::wait_for(Pacer& pacer, std::int64_t deadline_ns) noexcept {
  const std::int64_t lead_ns = settings_.rehearse_ns;
  if (lead_ns <= 0) return pacer.wait_until(deadline_ns);
  pacer.wait_until(deadline_ns - lead_ns);
  if (deadline_ns - pacer.now_ns() >= lead_ns / 2) {
    live_.rehearse();
    pacer.spin_until(deadline_ns - lead_ns / 4);
    if (deadline_ns - pacer.now_ns() >= lead_ns / 8) live_.rehearse();
  }
  pacer.spin_until(deadline_ns);
}

void HapticsLoop::tick(Pacer& pacer, const Wake& wake, std::int64_t woke_ns) noexcept {
  missed_.store(missed_.load(std::memory_order_relaxed) + wake.missed, std::memory_order_relaxed);
  LoopSnapshot snapshot = live_.run(seconds(woke_ns), controls_.newest());
  snapshot.missed_deadlines = missed_.load(std::memory_order_relaxed);
  if (wake.missed > 0) snapshot.faults |= loop_fault::kDeadlineMissed;
  newest_.write(snapshot);
  ring_->push(snapshot);

  const std::int64_t done_ns = pacer.now_ns();
  lateness_.add(wake.lateness_ns);
  duration_.add(done_ns - woke_ns);
  last_tick_ns_.store(done_ns, std::memory_order_relaxed);
}

void HapticsLoop::let_go(Pacer& pacer, Deadlines& deadlines) noexcept {
  for (int i = 0; i < kLetGoTicks; ++i) {
    pacer.wait_until(deadlines.next_ns());
    const std::int64_t woke_ns = pacer.now_ns();
    deadlines.wake(woke_ns);
    if (live_.run(seconds(woke_ns), kReleased).rendered_N == 0.0) break;
  }
  device_.write(0.0);
}

LoopStatistics HapticsLoop::statistics() const noexcept {
  LoopStatistics result;
  result.tick = duration_.percentiles();
  result.ticks = result.tick.count;
  result.missed_deadlines = missed_.load(std::memory_order_relaxed);
  result.dropped_snapshots = ring_->dropped();
  result.lateness = lateness_.percentiles();
  const std::int64_t last_ns = last_tick_ns_.load(std::memory_order_relaxed);
  if (last_ns != 0) result.age_s = seconds(steady_now_ns() - last_ns);
  return result;
}

bool FaultRecorder::add(const LoopSnapshot& snapshot) {
  if (ticks_.size() == kTicks) ticks_.pop_front();
  ticks_.push_back(snapshot);
  const bool fault = (snapshot.faults & loop_fault::kStops) != 0;
  const bool begins = !std::exchange(in_fault_, fault) && fault;
  if (left_ > 0) return --left_ == 0;
  if (begins) left_ = kTicksAfter;
  return false;
}

Status write_fault_file(const std::string& path, const std::deque<LoopSnapshot>& ticks) {
  Result<AtomicFile> file = AtomicFile::create(path, false);
  if (!file) return file.error();
  file->write(
      "loop_time_s,sample_time_s,position_m,velocity_m_per_s,commanded_N,rendered_N,sample_age_s,"
      "delay_ms,samples,faults,device_faults,limiter_flags\n");
  for (const LoopSnapshot& one : ticks) {
    std::string line;
    for (const double value :
         {one.loop_time_s, one.tick.time_s, one.tick.position_m, one.tick.velocity_m_per_s, one.commanded_N,
          one.rendered_N, one.device.sample_age_s, static_cast<double>(one.delay_ms)})
      line += shortest(value) + ",";
    line += std::to_string(one.samples) + "," + std::to_string(one.faults) + "," + std::to_string(one.device.faults) +
            "," + std::to_string(one.limiter_flags) + "\n";
    file->write(line);
  }
  return file->commit();
}

}  // namespace palpate
