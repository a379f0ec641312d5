// A recording run through the same tick as the live loop: no clock, no device,
// as fast as it goes. The same rows and models give the same bits every time.
//
// The sensor behind the samples is identified from the first
// kSensorIdentificationRows rows, so a recording in memory and the same one read
// in chunks give the same forces.
//
// In contact, for the visitor, is a sample beyond the surface, or one whose measured force is beyond both the
// JND at 0 N and five times its noise: an adhesive material pulls outside, too. The surface is the outermost of
// the models that have one of their own; without any it is at 0.
//
// Thread guarantee: slow side (allocates before the first row, calls the
// visitor); one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "engine/base/result.h"
#include "engine/recording/recording_reader.h"
#include "engine/tick/haptics_tick.h"
#include "engine/tick/tool_sample.h"

namespace palpate {

// Sees each row after its tick: `snapshot` has the forces, `tick` the feature
// vectors. All three live until it returns.
using ReplayVisitor =
    std::function<void(const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick)>;

using ForceModels = std::vector<std::shared_ptr<const ForceModel>>;

struct ReplaySummary {
  SensorSpec sensor;
  std::uint64_t samples = 0;
  std::uint64_t contact_samples = 0;
};

// A measured force beyond it is contact; from the first rows of a recording. `surface_m`: of the model.
double least_contact_N(const RecordingRow* rows, std::size_t count, double surface_m);

// `surface_offset_m` is subtracted from every position before the tick; the
// visitor still gets the row as recorded. Errors: more than kMaxModels models.
Result<ReplaySummary> replay(const Recording& recording, const ForceModels& models, const ReplayVisitor& visitor,
                             double surface_offset_m = 0.0);

// The rest of `reader` in bounded memory. Errors: as above, and any of the
// reader's; rows before the fault have been visited then.
Result<ReplaySummary> replay(RecordingReader& reader, const ForceModels& models, const ReplayVisitor& visitor,
                             double surface_offset_m = 0.0);

}  // namespace palpate
