// A 3Dconnexion SpaceMouse: pushing its cap down moves the tool into the block. It renders no force to the hand; the
// force acts on the simulated mass of a MouseDevice.
// It reports at 60 to 125 Hz, and not at all at rest. The target is interpolated linearly from one value to the next
// over the last interval of reports, so that it moves at every tick. This adds a delay of one interval.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "devices/link/device_calibration.h"
#include "devices/link/device_link.h"
#include "devices/virtual/mouse_device.h"
#include "engine/live/device.h"
#include "engine/live/handover.h"

namespace palpate {

// Converts reports to a target position at any time.
class SpaceMouseAxis final : public LinkListener {
 public:
  // Limits of the interval between reports.
  static constexpr double kShortest_s = 0.004;
  static constexpr double kLongest_s = 0.02;
  // Smaller deflections count as 0.
  static constexpr int kDeadCounts = 8;

  explicit SpaceMouseAxis(const DeviceCalibration& calibration) noexcept : calibration_(calibration) {}

  // Reader thread, wait-free.
  void connected(double) noexcept override;
  void report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept override;
  void unplugged() noexcept override;
  // Writer thread. Nothing is written to a SpaceMouse.
  OutReports next(double) noexcept override { return {}; }
  void written(double) noexcept override {}

  // Haptics thread, wait-free; `now_s` increasing. The target position of the tool.
  double target_m(double now_s) noexcept;
  // Haptics thread, wait-free. Sets the target of `tool` if it has changed since the last call.
  void drive(MouseDevice& tool, double now_s) noexcept;
  DeviceHealth health(double now_s) noexcept;

 private:
  struct Deflection {
    std::uint64_t reports = 0;
    double counts = 0.0;
    double at_s = 0.0;
    double interval_s = kLongest_s;
    double corrupt_until_s = 0.0;
    bool connected = false;
  };

  DeviceCalibration calibration_;
  TripleBuffer<Deflection> newest_;
  Deflection deflection_;  // reader thread only
  // Haptics thread only: the interpolation.
  std::uint64_t seen_ = 0;
  double from_counts_ = 0.0, to_counts_ = 0.0, since_s_ = 0.0, over_s_ = kShortest_s;
  double last_target_m_ = std::numeric_limits<double>::quiet_NaN();
};

// A SpaceMouseAxis with its threads.
class SpaceMouse {
 public:
  // `bus` outlives this.
  SpaceMouse(DeviceBus& bus, const DeviceCalibration& calibration, OpenedDevice opened);
  Status start() { return link_.start(); }
  void stop() noexcept { link_.stop(); }
  SpaceMouseAxis& axis() noexcept { return axis_; }
  std::string description() const { return link_.description(); }

 private:
  SpaceMouseAxis axis_;
  DeviceLink link_;
};

class SpaceMouseDevice final : public MouseDevice {
 public:
  explicit SpaceMouseDevice(std::unique_ptr<SpaceMouse> mouse) : MouseDevice({}, "hid"), mouse_(std::move(mouse)) {}
  ~SpaceMouseDevice() override { close(); }

  Status open() override { return mouse_->start(); }
  void close() noexcept override { mouse_->stop(); }
  bool read(double now_s, DeviceSample& sample) noexcept override {
    mouse_->axis().drive(*this, now_s);
    return MouseDevice::read(now_s, sample);
  }
  DeviceHealth health(double now_s) noexcept override { return mouse_->axis().health(now_s); }
  std::string note() const override { return mouse_->description(); }
  ToolInput* tool_input() noexcept override { return nullptr; }  // only the SpaceMouse moves the tool

 private:
  std::unique_ptr<SpaceMouse> mouse_;
};

}  // namespace palpate
