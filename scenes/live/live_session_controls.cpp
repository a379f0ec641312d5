// What the window may ask of a live session beside its models: reference, tool,
// replay, recording.
#include <cmath>

#include "devices/registry/auto_device.h"
#include "devices/virtual/replay_device.h"
#include "scenes/live/live_session.h"
#include "scenes/live/live_slot.h"

namespace palpate {
namespace {

WrittenForce written(ReferenceKind kind) {
  switch (kind) {
    case ReferenceKind::measured: return WrittenForce::measured;
    case ReferenceKind::truth: return WrittenForce::reference;
    case ReferenceKind::direct: return WrittenForce::model;
  }
  return WrittenForce::model;
}

}  // namespace

const std::string& LiveSession::device_name() const noexcept { return device_->name(); }
LoopStatistics LiveSession::statistics() const noexcept { return loop_->statistics(); }
const RtStatus& LiveSession::scheduling() const noexcept { return loop_->scheduling(); }

bool LiveSession::has_reference(ReferenceKind kind) const noexcept {
  switch (kind) {
    case ReferenceKind::measured: return replay_ != nullptr;
    case ReferenceKind::truth: return truth_ != nullptr;
    case ReferenceKind::direct: return direct_slot_.has_value();
  }
  return false;
}

void LiveSession::use_reference(ReferenceKind kind) {
  if (!has_reference(kind)) return;
  reference_ = kind;
  reset_errors();
}

std::string LiveSession::reference_words() const {
  switch (reference_) {
    case ReferenceKind::measured: return "force in the recording";
    case ReferenceKind::truth: return "true force of the virtual " + *scene_.material;
    case ReferenceKind::direct: return has_reference(reference_) ? "direct interpolant" : "no reference";
  }
  return {};
}

void LiveSession::reset_errors() {
  for (const auto& slot : slots_) slot->view.errors = {};
}

void LiveSession::reset_figures() {
  reset_errors();
  faults_.acknowledge();
  ++acknowledged_;
  send_controls();
}

bool LiveSession::device_pushes() const noexcept { return device_->renders_force(); }

std::string LiveSession::device_words() const {
  const DeviceHealth& device = newest_.device;
  // Why it has to be zeroed again comes first: unplugged, it cannot be.
  if (device.zeroing == Zeroing::needed && (device.faults & device_fault::kLosesPosition) != 0) {
    return device_fault_words(device.faults & device_fault::kLosesPosition).front();
  }
  std::string words = zeroing_words(device);
  if (words.empty() && newest_.released) {
    words = dead_man_ == DeadMan::grip ? "no force: hold the switch on the handle" : "no force: hold G";
  }
  return words;
}

void LiveSession::start_zeroing() { device_->start_zeroing(); }

void LiveSession::use_dead_man(DeadMan what) {
  dead_man_ = what;
  send_controls();
}

void LiveSession::hold() {
  held_s_ = steady_now_s();
  send_controls();
}

MouseDevice* LiveSession::mouse() const noexcept { return auto_ != nullptr ? &auto_->mouse() : mouse_; }

bool LiveSession::takes_mouse() const noexcept { return mouse() != nullptr; }

void LiveSession::set_tool_target(double position_m) {
  if (MouseDevice* device = mouse()) device->set_target(position_m, steady_now_s());
}

void LiveSession::nudge_tool(double by_m) {
  if (MouseDevice* device = mouse()) device->nudge(by_m, steady_now_s());
}

bool LiveSession::hand_is_exploring() const noexcept {
  if (auto_ != nullptr) return auto_->hand_is_exploring();
  return mouse_ == nullptr && replay_ == nullptr;
}

ReplayStatus LiveSession::replay() const noexcept {
  if (replay_ == nullptr) return {};
  return {true, replay_->paused(), replay_->speed(), replay_->playhead_s(), replay_->duration_s()};
}

void LiveSession::pause_replay(bool paused) {
  if (replay_ != nullptr) replay_->pause(paused);
}

void LiveSession::set_replay_speed(double speed) {
  if (replay_ != nullptr) replay_->set_speed(speed);
}

void LiveSession::seek_replay(double at_s) {
  if (replay_ != nullptr) replay_->seek(at_s);
}

std::vector<std::string> LiveSession::recording_comments() const {
  return {"recorded live; scene " + scene_.name + ", device " + device_->name(),
          "force_N: " + reference_words() + ", not what the device rendered",
          "a stream that starts over (end of a replay, seek) begins 30 s later than the last one ended"};
}

Status LiveSession::start_recording(const std::string& path) {
  if (!has_reference(reference_)) {
    return Error{"there is no force to record yet: no reference is ready; wait for one or choose another"};
  }
  RecorderRequest request;
  request.path = path;
  request.force = written(reference_);
  const SensorSpec sensor = device_->sensor();
  request.columns = {sensor.has_velocity, sensor.has_acceleration};
  request.comments = recording_comments();
  if (Status status = recorder_->start(request); !status) return status;
  recording_ = recorder_->number();
  send_controls();
  return {};
}

void LiveSession::stop_recording() {
  recording_ = 0;
  send_controls();
  recorder_->stop();
}

RecordingStatus LiveSession::recording() const noexcept { return recorder_->status(); }

}  // namespace palpate
