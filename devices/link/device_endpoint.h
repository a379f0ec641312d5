// A device that renders force (HID or bridge). DeviceEndpoint has neither threads nor I/O; LinkedDevice adds them. The
// reader thread gives it reports, the writer thread fetches commands, the haptics thread reads samples and writes
// forces.
// A device with an incremental encoder gives neither samples nor force until it is zeroed, as zeroing_words describes,
// at rest_position_m of the calibration; again after it was unplugged or restarted, or its encoder jumped or was stuck.
// The writer is a watchdog: when the haptics thread has not written for kHapticsSilent_s, the writer sends force 0. The
// heartbeat in the frames of the bridge then stops, so that the board's watchdog acts as well.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "devices/link/device_link.h"
#include "devices/link/device_protocol.h"
#include "devices/link/stream_monitor.h"
#include "engine/live/device.h"
#include "engine/live/handover.h"

namespace palpate {

class DeviceEndpoint : public Device, public LinkListener {
 public:
  static constexpr double kHapticsSilent_s = 0.02;
  // kWriteStalled is reported when no command was written, or none confirmed, for this time.
  static constexpr double kWriteStalled_s = 0.05;
  // An unchanged command is repeated after this time.
  static constexpr double kRepeat_s = 0.005;
  // A device that confirms nothing is on USB: a frame of 1 ms in each direction; and the longest waits for the tick and
  // for the writer.
  static constexpr double kUsb_s = 2e-3, kWaits_s = 1.5e-3;
  // A device with timed reports gets one command per sample that the tick has used, but at least one in this time.
  static constexpr double kSlowestSample_s = 0.01;

  explicit DeviceEndpoint(const DeviceCalibration& calibration, std::string name = "hid") noexcept;

  const std::string& name() const noexcept override { return name_; }
  SensorSpec sensor() const noexcept override;
  Holder holder() const noexcept override { return Holder::person; }
  ForceLimits limits() const noexcept override;

  // As LinkListener, wait-free.
  void connected(double now_s) noexcept override;
  void report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept override;
  void unplugged() noexcept override;
  OutReports next(double now_s) noexcept override;
  void written(double now_s) noexcept override { last_written_s_.store(now_s, std::memory_order_relaxed); }

  // As Device, wait-free.
  bool read(double now_s, DeviceSample& sample) noexcept override;
  void write(double force_N) noexcept override;
  DeviceHealth health(double now_s) noexcept override;
  void start_zeroing() noexcept override { zeroing_asked_.store(true, std::memory_order_relaxed); }

 private:
  struct Command {
    double force_N = 0.0;
    std::uint64_t sample = 0;   // number of the sample from which the force was computed; 0: none
    std::uint32_t from_us = 0;  // its time, device clock
    std::uint16_t heartbeat = 0;
  };
  struct TimedSample {
    DeviceSample sample;
    std::uint64_t number = 0;
    std::uint32_t time_us = 0;  // device clock
  };

  bool stalled(const MonitorState& state, double now_s) const noexcept;
  // Reader thread.
  void publish_state() noexcept;
  void publish_sample(const DeviceReading& reading, double now_s) noexcept;
  ForceAge force_age(const DeviceReading& reading, double now_s) noexcept;

  DeviceCalibration calibration_;
  std::string name_;
  std::atomic<bool> zeroing_asked_{false};
  std::atomic<double> commanded_N_{0.0};  // last command
  std::atomic<double> last_written_s_{0.0};
  std::atomic<double> connected_at_s_{0.0};
  // For the last commands, by sequence modulo 256: the low half of the sequence, kFromSample, and Command::from_us.
  std::array<std::atomic<std::uint64_t>, 256> sent_{};
  static constexpr std::uint64_t kFromSample = std::uint64_t{1} << 48;
  static_assert(std::atomic<double>::is_always_lock_free && std::atomic<std::uint64_t>::is_always_lock_free);
  TripleBuffer<MonitorState> state_;
  SpscRing<TimedSample, 256> samples_;
  TripleBuffer<Command> command_;
  // Reader thread only.
  StreamMonitor monitor_;
  std::uint32_t acted_from_us_ = 0;  // device time of the sample of the force that acted at the newest sample
  bool acted_known_ = false;
  double arrived_s_ = std::numeric_limits<double>::quiet_NaN();  // the newest sample
  bool connected_ = false;
  std::uint32_t streams_published_ = 0;
  // Writer thread only.
  std::uint32_t sequence_ = 0;
  std::uint16_t last_heartbeat_ = 0;
  double last_beat_s_ = 0.0, last_sent_s_ = -1.0;
  std::uint64_t answered_ = 0;  // sample of the last command
  // Haptics thread only.
  Command next_command_;
};

class LinkedDevice final : public DeviceEndpoint {
 public:
  // `bus` outlives this, or is `own_bus`; `opened` has the calibration's protocol; `name`: as in --device.
  LinkedDevice(DeviceBus& bus, const DeviceCalibration& calibration, OpenedDevice opened, std::string name = "hid",
               std::unique_ptr<DeviceBus> own_bus = nullptr)
      : DeviceEndpoint(calibration, std::move(name)),
        own_bus_(std::move(own_bus)),
        measures_force_(opened.measures_force),
        link_(bus, *this, std::move(opened)) {}
  ~LinkedDevice() override { close(); }

  bool measures_force() const noexcept override { return measures_force_; }
  // Errors: a thread cannot be started.
  Status open() override { return link_.start(); }
  void close() noexcept override { link_.stop(); }
  std::string note() const override { return link_.description(); }

 private:
  std::unique_ptr<DeviceBus> own_bus_;
  bool measures_force_;
  DeviceLink link_;
};

}  // namespace palpate
