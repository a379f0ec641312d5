#include "engine/live/fault_recorder.h"

#include "engine/base/atomic_file.h"
#include "engine/base/csv_scanner.h"

namespace palpate {

void FaultRecorder::add(const FaultTick& tick, bool fault) noexcept {
  rings_[active_][ends_[active_]] = tick;
  ends_[active_] = (ends_[active_] + 1) % kTicks;
  if (counts_[active_] < kTicks) ++counts_[active_];
  const bool begins = fault && !in_fault_;
  in_fault_ = fault;
  if (left_ > 0) {
    if (--left_ == 0) publish();
  } else if (begins) {
    left_ = kTicksAfter;
  }
}

void FaultRecorder::finish() noexcept {
  if (left_ > 0) publish();
  left_ = 0;
}

void FaultRecorder::publish() noexcept {
  if (handed_.load(std::memory_order_acquire) >= 0) {
    dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    return;
  }
  handed_.store(static_cast<int>(active_), std::memory_order_release);
  active_ = 1 - active_;
  ends_[active_] = counts_[active_] = 0;
}

std::optional<std::vector<FaultTick>> FaultRecorder::read() {
  const int handed = handed_.load(std::memory_order_acquire);
  if (handed < 0) return std::nullopt;
  const auto ring = static_cast<std::size_t>(handed);
  std::vector<FaultTick> ticks;
  ticks.reserve(counts_[ring]);
  const std::size_t first = (ends_[ring] + kTicks - counts_[ring]) % kTicks;
  for (std::size_t i = 0; i < counts_[ring]; ++i) ticks.push_back(rings_[ring][(first + i) % kTicks]);
  handed_.store(-1, std::memory_order_release);
  return ticks;
}

Status write_fault_file(const std::string& path, const std::vector<FaultTick>& ticks) {
  Result<AtomicFile> file = AtomicFile::create(path, false);
  if (!file) return file.error();
  file->write(
      "loop_time_s,sample_time_s,position_m,velocity_m_per_s,commanded_N,rendered_N,sample_age_s,"
      "round_trip_s,samples,faults,device_faults,limiter_flags\n");
  for (const FaultTick& tick : ticks) {
    std::string line;
    for (const double value : {tick.loop_time_s, tick.sample_time_s, tick.position_m, tick.velocity_m_per_s,
                               tick.commanded_N, tick.rendered_N, tick.sample_age_s, tick.round_trip_s}) {
      line += shortest(value) + ",";
    }
    line += std::to_string(tick.samples) + "," + std::to_string(tick.faults) + "," +
            std::to_string(tick.device_faults) + "," + std::to_string(tick.limiter_flags) + "\n";
    file->write(line);
  }
  return file->commit();
}

}  // namespace palpate
