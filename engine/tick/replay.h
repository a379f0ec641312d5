// Replays a recording through the tick of the live loop, without clock and device, as fast as possible. The same rows
// and models give the same bits.
//
// For the visitor, a sample is in contact if it is beyond the surface, the outermost of those surfaces of the models
// that are not at 0, or if the measured force exceeds both the JND at 0 N and five times its noise, because an adhesive
// material also pulls outside. Thread guarantee: slow side; one thread at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/recording/recording.h"
#include "engine/tick/haptics_tick.h"

namespace palpate {

// Called for each row after its tick: `snapshot` has the forces, `tick` the feature vectors. The references are valid
// during the call.
using ReplayVisitor =
    std::function<void(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick)>;

struct ReplaySummary {
  SensorSpec sensor;
  std::uint64_t samples = 0, contact_samples = 0;
  std::vector<int> began{};  // of each model (HapticsTick::began)
};

// The measured force above which a sample is in contact, N (certain_force_N). The noise is that of the first rows of a
// recording: the white noise or, if larger, the standard deviation before the first contact.
double least_contact_N(const RecordingRow* rows, std::size_t count, double surface_m);

// `models`: up to kMaxModels. `surface_offset_m` is subtracted from every position before the tick; the visitor
// receives the row as recorded. `after`: the recording that this one continues (HapticsTick::start_after); null: none.
ReplaySummary replay(const Recording& recording, const ForceModels& models, const ReplayVisitor& visitor,
                     double surface_offset_m = 0.0, const Recording* after = nullptr);

}  // namespace palpate
