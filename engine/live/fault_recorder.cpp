#include "engine/live/fault_recorder.h"

#include <utility>

#include "engine/base/atomic_file.h"
#include "engine/base/text.h"

namespace palpate {

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
      "round_trip_s,samples,faults,device_faults,limiter_flags\n");
  for (const LoopSnapshot& one : ticks) {
    std::string line;
    for (const double value : {one.loop_time_s, one.tick.time_s, one.tick.position_m, one.tick.velocity_m_per_s,
                               one.commanded_N, one.rendered_N, one.device.sample_age_s, one.device.round_trip_s}) {
      line += shortest(value) + ",";
    }
    line += std::to_string(one.samples) + "," + std::to_string(one.faults) + "," + std::to_string(one.device.faults) +
            "," + std::to_string(one.limiter_flags) + "\n";
    file->write(line);
  }
  return file->commit();
}

}  // namespace palpate
