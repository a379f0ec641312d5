// The threads between an open device and its listener: the reader takes all reports, so that none queue up; the writer
// sends the newest command and skips older ones. Only they do blocking I/O. A device that was unplugged is searched for
// and opened again until the link ends.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "devices/link/device_protocol.h"
#include "engine/base/result.h"

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

// An open device, its node and its protocol.
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

  // Slow side. Errors: a thread cannot be started.
  Status start();
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

}  // namespace palpate
