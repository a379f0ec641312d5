// The threads between an open device and its listener: the reader takes all reports, so that none queue up; the writer
// sends the newest command and skips older ones. Only they do blocking I/O. A device that was unplugged is searched for
// and opened again until the link ends.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "devices/link/device_protocol.h"
#include "engine/base/result.h"
#include "engine/live/device.h"
#include "engine/live/handover.h"

namespace palpate {

// One open device. One thread may call `read` and another one `write` at the same time; the rest is slow side.
class DeviceConnection {
 public:
  virtual ~DeviceConnection() = default;
  // Blocks for a limited time. Returns the size of the next report; 0: none yet; below 0: the device is gone.
  virtual int read(std::uint8_t* bytes, std::size_t capacity) noexcept = 0;
  // Blocking. False: the report was not accepted.
  virtual bool write(const std::uint8_t* bytes, std::size_t size) noexcept = 0;
  // The file to which the stop report is written when a signal ends the program (register_device_stop); -1: none.
  virtual int descriptor() const noexcept { return -1; }
};

// USB HID (devices/hid), a byte stream (devices/bridge), or a test double. Slow side.
class DeviceBus {
 public:
  virtual ~DeviceBus() = default;
  virtual std::vector<DeviceNode> list() = 0;
  // Errors: the node cannot be opened; with the reason and what to do.
  virtual Result<std::unique_ptr<DeviceConnection>> open(const DeviceNode& node) = 0;
};

// Receives the reports of a link and gives the commands to write. `now_s`: steady clock.
class LinkListener {
 public:
  virtual ~LinkListener() = default;
  // Reader thread.
  virtual void connected(double now_s) noexcept = 0;
  virtual void report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept = 0;
  virtual void unplugged() noexcept = 0;
  // Writer thread, of a protocol that renders force.
  virtual OutReports next(double) noexcept { return {}; }  // empty: nothing to write now
  virtual void written(double) noexcept {}
};

struct OpenedDevice {
  DeviceNode info{};
  const DeviceProtocol* protocol = nullptr;
  std::unique_ptr<DeviceConnection> connection{};  // null: no device was found
  bool measures_force = false;
};

// Opens the first device of one of `protocols`; returns no connection if none is plugged in. If one is plugged in but
// cannot be opened, it tries for half a second, because udev may still be setting the permissions. Slow side. Errors:
// none of the devices that are plugged in can be opened, with the reason for each.
Result<OpenedDevice> open_first(DeviceBus& bus, const std::vector<const DeviceProtocol*>& protocols);

class DeviceLink {
 public:
  // Period of the writer: half of that of the haptics thread.
  static constexpr std::int64_t kWritePeriod_ns = 500'000;
  static constexpr double kLookAgain_s = 0.25;  // between two searches for an unplugged device

  // `bus` and `listener` outlive this.
  DeviceLink(DeviceBus& bus, LinkListener& listener, OpenedDevice opened);
  ~DeviceLink();

  Status start();  // slow side; errors: a thread cannot be started
  // Slow side, blocking: ends the writer, sends the stop report, which removes the force, and closes the connection.
  void stop() noexcept;
  // Protocol, product, node and what it was tested on, e.g. "OpenFFBoard, one axis: FFBoard, /dev/hidraw7".
  std::string description() const;

 private:
  void read_all() noexcept;
  void write_all() noexcept;
  bool write(DeviceConnection& connection, const OutReports& reports) noexcept;
  void use(std::shared_ptr<DeviceConnection> next) noexcept;
  std::shared_ptr<DeviceConnection> connection() noexcept;
  void look_again() noexcept;

  DeviceBus& bus_;
  LinkListener& listener_;
  DeviceNode info_;
  const DeviceProtocol& protocol_;
  std::mutex mutex_;  // guards connection_; the haptics thread never locks it
  std::shared_ptr<DeviceConnection> connection_;
  int stop_slot_ = -1;               // of connection_, see register_device_stop
  std::atomic<bool> stop_{false};    // ends the writer
  std::atomic<bool> closed_{false};  // ends the reader
  std::thread reader_;
  std::thread writer_;
};

// Sends the stop report to every open device when a signal ends the program. This does not cover SIGKILL, a power
// failure or a hung system. When the host is silent, working firmware removes the force:
//   bridge       50 ms after the last valid frame or change of the heartbeat
//   OpenFFBoard  50 ms after the host last restarted its effect (devices/hid/openffboard.cpp)
//   SpaceMouse   renders no force
// Firmware that hangs while it drives the motor is not covered.
//
// Any thread but the haptics thread; installs the handlers of signals.h. When one of its signals ends the program, new
// writes of forces are refused, running ones get 20 ms to finish, `reports` are written to `descriptor`, which must
// stay open until `unregister_device_stop`, and the devices get 30 ms to take them. Returns the slot; -1 when all eight
// are in use.
int register_device_stop(int descriptor, const OutReports& reports) noexcept;
// Any thread but the haptics thread. -1 is ignored.
void unregister_device_stop(int slot) noexcept;

// To be called around every write of a report that may have a force. Any thread, wait-free. False: a signal is ending
// the program; do not write, and report the write as failed. True: call `end_force_write` after the write.
bool begin_force_write() noexcept;
void end_force_write() noexcept;

// A device that renders force (HID or bridge). DeviceEndpoint has neither threads nor I/O; LinkedDevice adds them. The
// reader thread gives it reports, the writer thread fetches commands, the haptics thread reads samples and writes
// forces.
// A device with an incremental encoder gives neither samples nor force until it is zeroed, as zeroing_words describes,
// at rest_position_m of the calibration; again after it was unplugged or restarted, or its encoder jumped or was stuck.
// The writer is a watchdog: when the haptics thread has not written for kHapticsSilent_s, the writer sends force 0. The
// heartbeat in the frames of the bridge then stops, so that the board's watchdog acts as well.

// Monitors the readings of one device, for all transports: position, zeroing and faults. It has no clock and no thread,
// and does not decode. A fault on the right has the cause on the left:
//
//   the decoder refuses a report of another version                       kWrongFirmware
//   a sequence number decreases                                           kOutOfOrder
//   timed: a sample is older than late_after_s                            kLate
//   untimed: four reports within kTogether_s waited in a queue            kBurst
//   a step is faster than the device or a hand can move                   kJump
//   sequence numbers or the device's time start again                     kReset
//   no count changes within `stuck_after_s` at kPushing_N or more,
//     although the force is kFirm_N or changes by kPushing_N              kStuck
//   the device's watchdog has stopped it                                  kWriteStalled
//   the device reports a fault                                            kOwn
//   fewer than 100 samples a second                                       kSlow
// Missing reports are detected by DeviceEndpoint::health; a corrupt report is a missing one. A fault that does not
// affect the position lasts kHold_s after its last occurrence, one that comes often kOften_s. A fault that loses the
// position of an incremental encoder (kJump, kReset, kStuck) lasts until the device is zeroed. A reading that is out of
// order or late is not used. Thread guarantee: one thread; wait-free, never throws.

// Converts the device's time of a sample to the host's clock. The device's clock is assumed linear in the host's clock,
// and every report arrives with a delay of the transport:
//
//   arrival - device time = a + b (device time) + delay,  delay >= 0
//
// The line is the highest one below all points of the last half second (the linear programme of Moon, Skelly & Towsley,
// "Estimation and removal of clock skew from network delay measurements", INFOCOM 1999), of which only the lowest one
// in each 50 ms is used. This removes jitter and follows drift at every rate of reports. A delay that stays longer for
// more than half a second becomes part of the line.
class DeviceClock {
 public:
  // `device_us` wraps at 32 bits; `arrival_s` is non-decreasing. Returns host seconds, at most `arrival_s`.
  double host_time_s(std::uint32_t device_us, double arrival_s) noexcept {
    if (started_) device_s_ += 1e-6 * static_cast<double>(static_cast<std::int32_t>(device_us - last_us_));
    last_us_ = device_us;
    const Point point{device_s_, arrival_s - device_s_};
    if (!started_) {
      started_ = true;
      middle_s_ = device_s_;
      level_s_ = point.lag_s;
      lowest_ = point;
    }
    if (point.device_s - segment_from_s_ >= kSegment_s) {
      points_[count_++ % kSegments] = lowest_;
      fit();
      segment_from_s_ = point.device_s;
      lowest_ = point;
    }
    if (above_line_s(point) < above_line_s(lowest_)) lowest_ = point;
    level_s_ += std::min(0.0, above_line_s(point));
    return std::min(arrival_s, arrival_s - above_line_s(point));
  }

 private:
  // Well above the error of a ceramic resonator, 0.5 %, plus that of a host clock which is slewed, 0.5 %.
  static constexpr double kLargestDrift = 0.015, kSegment_s = 0.05;
  static constexpr std::size_t kSegments = 10;

  struct Point {
    double device_s = 0.0, lag_s = 0.0;
  };

  double above_line_s(const Point& point) const noexcept {
    return point.lag_s - level_s_ - drift_ * (point.device_s - middle_s_);
  }

  // Among the slopes between two points, chooses the one whose line is highest at the mean time.
  void fit() noexcept {
    const std::size_t count = std::min(count_, kSegments);
    middle_s_ = 0.0;
    for (std::size_t i = 0; i < count; ++i) middle_s_ += points_[i].device_s / static_cast<double>(count);
    level_s_ = -std::numeric_limits<double>::infinity();
    try_slope(0.0, count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double slope = (points_[i].lag_s - points_[j].lag_s) / (points_[i].device_s - points_[j].device_s);
        try_slope(std::clamp(slope, -kLargestDrift, kLargestDrift), count);
      }
    }
  }
  void try_slope(double slope, std::size_t count) noexcept {
    double level_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i)
      level_s = std::min(level_s, points_[i].lag_s - slope * (points_[i].device_s - middle_s_));
    if (!(level_s > level_s_)) return;
    level_s_ = level_s;
    drift_ = slope;
  }

  std::array<Point, kSegments> points_{};
  std::size_t count_ = 0;
  Point lowest_;  // of the present segment
  double segment_from_s_ = 0.0;
  double middle_s_ = 0.0, level_s_ = 0.0, drift_ = 0.0;  // the line
  double device_s_ = 0.0;
  std::uint32_t last_us_ = 0;
  bool started_ = false;
};

// The state after a report. The haptics thread gets a copy of it.
struct MonitorState {
  std::uint64_t samples = 0;   // number of accepted samples
  std::uint64_t corrupt = 0;   // number of corrupt reports since the last of them
  std::int64_t counts = 0;     // of the newest accepted sample, unwrapped
  double sample_time_s = 0.0;  // host clock, strictly increasing
  double zero_counts = 0.0;    // counts at the rest position
  double transient_until_s = 0.0;
  double confirmed_at_s = 0.0;  // time of the last change of DeviceReading::confirmed
  std::uint32_t transient = 0;  // bits of device_fault that end at transient_until_s
  std::uint32_t lost = 0;       // bits of device_fault that end when the device is zeroed
  std::uint32_t streams = 0;    // number of streams; one begins when the position becomes known or jumps
  double late_after_s = 0.0;    // largest permitted age of a sample, see kLateIntervals
  double measured_N = std::numeric_limits<double>::quiet_NaN();
  DeviceHealth health;  // zeroing, grip and interval
};

class StreamMonitor {
 public:
  static constexpr double kHold_s = 0.1, kTogether_s = 0.5e-3, kPushing_N = 0.2, kFirm_N = 1.0;
  // A fault that comes again within this time lasts as long, so that a line at its limit does not switch the force on
  // and off.
  static constexpr double kOften_s = 2.0;
  // Largest acceleration: 50 N of hand and motor together on 50 g. A motion of 5 mm within 1 ms from rest is therefore
  // a fault even where fastest_m_per_s allows it.
  static constexpr double kQuickest_m_per_s2 = 1000.0;
  // For zeroing the tool has to rest within kRest_m for this time.
  static constexpr double kZeroing_s = 0.2;
  static constexpr double kRest_m = 0.5e-3;
  // The device has restarted when so many successive readings are in order but older than the last accepted one.
  static constexpr int kStartedAgain = 8;
  // A sample of a timed stream is late when it is older than kLateIntervals intervals, clamped to stale_after_s ..
  // kLongestSilence_s. After a late sample the limit is half of that.
  static constexpr double kLateIntervals = 5.0, kLongestSilence_s = 0.1, kOnTimeAgain = 0.5;
  // A new timed stream begins after kLongestSilence_s without a usable reading, or when the device's clock was set
  // back. The readings of its first kSettling_s only fit the clock, because they may have waited in a queue.
  static constexpr double kSettling_s = 0.05;

  explicit StreamMonitor(const DeviceCalibration& calibration) noexcept;

  // Takes a decoded report that arrived at `now_s` (non-decreasing). `force_N`: the commanded force.
  void update(ReportVerdict verdict, const DeviceReading& reading, double now_s, double force_N) noexcept;
  void fault(std::uint32_t bit, double now_s) noexcept;
  // The device was unplugged; the next report begins a new stream.
  void unplugged() noexcept;
  void start_zeroing() noexcept;

  const MonitorState& state() const noexcept { return state_; }

 private:
  void lose(std::uint32_t bit, double now_s) noexcept;
  // Whether the reading is used. They set read_time_s_; a new stream ends connected_.
  bool accept_untimed(double now_s) noexcept;
  bool accept_timed(const DeviceReading& reading, double now_s) noexcept;
  void move(const DeviceReading& reading, double now_s) noexcept;
  void watch_stuck(double now_s, double force_N) noexcept;
  void watch_zeroing(double now_s) noexcept;

  DeviceCalibration calibration_;
  const DeviceProtocol& protocol_;
  MonitorState state_;
  DeviceClock clock_;
  SampleRate rate_;
  DeviceReading last_;
  std::uint32_t refused_ = 0;  // sequence of the last reading that was out of order
  int refused_in_order_ = 0;
  bool connected_ = false;                     // a reading was accepted since the present stream began
  double first_s_ = -1.0;                      // arrival of the first reading of a new timed stream; below 0: none
  double read_time_s_ = 0.0;                   // of the present reading
  double speed_ = 0.0;                         // counts per second, of the last step
  double arrivals_s_[3] = {-1e9, -1e9, -1e9};  // of the last three untimed readings, newest first
  double still_since_s_ = 0.0;                 // the last change of a count
  double least_N_ = 0.0, most_N_ = 0.0;        // of the force since then
  bool pushed_ = false;                        // at the last sample
  bool stuck_ = false;
  bool late_ = false;
  double hold_s_ = kHold_s;        // of the present fault
  double zeroing_since_s_ = -1.0;  // below 0: not begun
  std::int64_t zeroing_from_ = 0, zeroing_to_ = 0;
};

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
  std::uint32_t began_us_ = 0, aged_stream_ = 0;  // the first sample of the present stream
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
  Status open() override { return link_.start(); }
  void close() noexcept override { link_.stop(); }
  std::string note() const override { return link_.description(); }

 private:
  std::unique_ptr<DeviceBus> own_bus_;
  bool measures_force_;
  DeviceLink link_;
};

}  // namespace palpate
