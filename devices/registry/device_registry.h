// The devices by the names of the option --device.
// Thread guarantee: slow side.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "devices/link/device_link.h"
#include "devices/link/device_protocol.h"
#include "devices/virtual/simulated_devices.h"
#include "engine/live/device.h"
#include "engine/live/pacer.h"

namespace palpate {

struct DeviceDescription {
  std::string name;     // as in --device
  std::string summary;  // one line
  Holder holder = Holder::none;
  std::string problem;  // why it cannot be opened and what to do; empty: it can be opened
};

struct DeviceRequest {
  std::uint64_t seed = 1;  // of the simulated hand
  HandSettings hand{};     // of the simulated hand
  // Folder of the calibrations, assets/devices, without which no HID or bridge device can be opened.
  std::string calibrations{};
  DeviceBus* bus = nullptr;  // bus of the HID devices; null: that of this machine
};

// A device of the table and its factory. `what` is the part of its name after the colon.
using MadeDevice = Result<std::unique_ptr<Device>>;
struct DeviceEntry {
  DeviceDescription description;
  MadeDevice (*make)(const std::string& what, const DeviceRequest& request);
};
// The table of all devices, the default first. A new device is a line of this table.
const std::vector<DeviceEntry>& device_entries();

// The descriptions of the table. Opens and closes HID devices to find out whether they can be used, which takes half a
// second when one cannot.
std::vector<DeviceDescription> list_devices(const DeviceRequest& request = {});

// Makes and opens the device of that name. "auto" is the first haptic HID device that can be opened. Without one it is
// an AutoDevice, and its `note` has the reason. Errors: an unknown name (lists the known ones), a recording that cannot
// be read, a device that cannot be opened.
MadeDevice open_device(const std::string& name, const DeviceRequest& request = {},
                       const std::vector<DeviceEntry>& entries = device_entries());

// The simulated hand until the user moves the mouse or a SpaceMouse, and again once both have been idle for
// MouseDevice::kIdleTime_s. The tool continues from its last position.
// Pushing the cap of a 3Dconnexion SpaceMouse down moves the target into the block. It renders no force to the hand;
// the force acts on the simulated mass of the MouseDevice, whose low-pass filter turns the 60 to 125 reports a second
// (none at rest) into a motion at every tick.
// Thread guarantee: as Device and ToolInput.

class AutoDevice final : public MouseDevice, public LinkListener {
 public:
  // `note`: see Device::note.
  explicit AutoDevice(std::uint64_t seed = 1, const HandSettings& hand = {}, std::string note = "")
      : MouseDevice("auto"), note_(std::move(note)), hand_(seed, hand) {}
  // With a SpaceMouse, which `opened` is; `bus` outlives this.
  AutoDevice(DeviceBus& bus, const DeviceCalibration& calibration, OpenedDevice opened, std::uint64_t seed = 1,
             const HandSettings& hand = {}, std::string note = "")
      : AutoDevice(seed, hand, std::move(note)) {
    calibration_ = calibration;
    space_mouse_.emplace(bus, *this, std::move(opened));
  }

  Status open() override { return space_mouse_ ? space_mouse_->start() : Status(); }
  void close() noexcept override {
    if (space_mouse_) space_mouse_->stop();
  }
  std::string note() const override { return note_; }
  bool read(double now_s, DeviceSample& sample) noexcept override {
    const bool exploring = idle(now_s);
    // Only this thread writes exploring_.
    const bool was_exploring = exploring_.load(std::memory_order_relaxed);
    if (exploring && !was_exploring) hand_.resume_at(position_m(), now_s);
    if (!exploring && was_exploring) resume_at(hand_.position_m(), hand_.velocity_m_per_s(), now_s);
    exploring_.store(exploring, std::memory_order_relaxed);
    // A change of the source gives no sample; the tool moves from the next tick on.
    if (exploring != was_exploring) return false;
    return exploring ? hand_.read(now_s, sample) : MouseDevice::read(now_s, sample);
  }
  void write(double force_N) noexcept override {
    hand_.write(force_N);
    MouseDevice::write(force_N);
  }
  // Any thread, wait-free. A target stops the simulated hand.
  bool hand_is_exploring() const noexcept override { return exploring_.load(std::memory_order_relaxed); }

  // As LinkListener, of the SpaceMouse; wait-free.
  void connected(double) noexcept override {}
  void report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept override {
    DeviceReading reading;
    if (calibration_.protocol->decode(bytes, size, reading) == ReportVerdict::position) deflect(reading.counts, now_s);
  }
  void unplugged() noexcept override { deflect(0, steady_now_s()); }

 private:
  // Smaller deflections count as 0: the cap does not return to its exact centre.
  static constexpr int kDeadCounts = 8;

  void deflect(int counts, double now_s) noexcept {
    if (std::abs(counts) < kDeadCounts) counts = 0;
    if (counts == std::exchange(counts_, counts)) return;
    set_target(calibration_.rest_position_m + calibration_.direction * counts / calibration_.counts_per_metre, now_s);
  }

  std::string note_;
  HandDevice hand_;
  std::atomic<bool> exploring_{true};
  DeviceCalibration calibration_;
  int counts_ = 0;  // reader thread of the SpaceMouse: the deflection of its cap
  std::optional<DeviceLink> space_mouse_;
};

}  // namespace palpate
