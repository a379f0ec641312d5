#include "rendering/app/stats_file.h"

#include <nlohmann/json.hpp>

namespace palpate {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMsPerUs = 1e-3;

Json times_json(const TimePercentiles& times) {
  return {{"p50", times.p50_us}, {"p99", times.p99_us}, {"p99_9", times.p99_9_us}, {"max", times.max_us}};
}

Json haptics_json(const LiveSession& session) {
  const LoopStatistics statistics = session.loop().statistics();
  const RtStatus& granted = session.loop().scheduling();
  return {{"ticks", statistics.ticks},
          {"missed_deadlines", statistics.missed_deadlines},
          {"lateness_us", times_json(statistics.lateness)},
          {"tick_us", times_json(statistics.tick)},
          {"scheduling", granted.scheduling},
          {"scheduling_fix", granted.fix}};
}

Json graphics_json(const FrameFigures& frames) {
  const TimePercentiles times = frames.times.percentiles();
  return {{"frames", frames.frames},
          {"fps", frames.seconds > 0.0 ? static_cast<double>(frames.frames) / frames.seconds : 0.0},
          {"picture_scale", frames.picture_scale},
          {"frame_ms",
           {{"p50", kMsPerUs * times.p50_us}, {"p99", kMsPerUs * times.p99_us}, {"max", kMsPerUs * times.max_us}}}};
}

// Figures are null if there are no samples.
Json model_json(const ModelView& slot) {
  const bool has_errors = slot.errors.samples > 0;
  return {{"name", slot.name},
          {"method", slot.method},
          {"centres", slot.centres},
          {"samples", slot.errors.samples},
          {"within_jnd", has_errors ? Json(slot.errors.within_jnd) : Json(nullptr)},
          {"rms_error_N", has_errors ? Json(slot.errors.rms_error_N) : Json(nullptr)},
          {"max_error_over_jnd", has_errors ? Json(slot.errors.max_error_over_jnd) : Json(nullptr)},
          {"p99_error_over_jnd", has_errors ? Json(slot.errors.p99_error_over_jnd) : Json(nullptr)},
          {"tick_ns", slot.tick_ns() > 0.0 ? Json(slot.tick_ns()) : Json(nullptr)}};
}

}  // namespace

std::string stats_text(const LiveSession& session, const WindowView& shown, const FrameFigures& frames) {
  Json models = Json::array();
  for (const ModelView& model : shown.models.slots) {
    if (model.state == SlotState::ready) models.push_back(model_json(model));
  }
  Json faults = Json::array();
  for (const FaultEvent& fault : session.faults().events()) {
    faults.push_back({{"loop_time_s", fault.loop_time_s}, {"text", fault.text}, {"count", fault.count}});
  }
  const Json all = {{"haptics", haptics_json(session)},
                    {"graphics", graphics_json(frames)},
                    {"models", models},
                    {"verdict", shown.models.verdict.headline},
                    {"faults", faults},
                    {"scene", session.scene().name},
                    {"device", session.device_name()},
                    {"reference", session.reference_words()}};
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace palpate
