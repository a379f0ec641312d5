// The threads between an open device and its user: one that reads whatever comes,
// so that nothing queues up, and one that writes the newest command and forgets
// those that it had no time for. Blocking I/O is theirs alone. A device that goes
// away is looked for again until the link ends.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "devices/link/device_bus.h"
#include "engine/base/result.h"

namespace palpate {

// Who is told of a link's reports and asked what to write. `now_s`: steady clock.
class LinkListener {
 public:
  virtual ~LinkListener() = default;
  // Reader thread.
  virtual void connected(double now_s) noexcept = 0;
  virtual void report_arrived(const std::uint8_t* bytes, std::size_t size, double now_s) noexcept = 0;
  virtual void unplugged() noexcept = 0;
  // Writer thread.
  virtual OutReports next(double now_s) noexcept = 0;
  virtual void written(double now_s) noexcept = 0;
};

// An open device and how to find it again.
struct OpenedDevice {
  DeviceNode info;
  const DeviceProtocol* protocol = nullptr;  // of one that was opened: never null
  std::unique_ptr<DeviceConnection> connection;
  bool measures_force = false;
};

// The first device of one of `protocols` that can be opened; tries for half a second
// when there is one that cannot, for udev may still be setting its permissions.
// Slow side. Errors: none is plugged in (`none_found` is then set); those that are
// cannot be opened, each with why.
Result<OpenedDevice> open_first(DeviceBus& bus, const DeviceProtocols& protocols, bool* none_found = nullptr);

class DeviceLink {
 public:
  // Writes at most this often; a device gets a report every 1 ms.
  static constexpr std::int64_t kWritePeriod_ns = 500'000;
  static constexpr double kLookAgain_s = 0.25;

  // `bus` and `listener` outlive this.
  DeviceLink(DeviceBus& bus, LinkListener& listener, OpenedDevice opened);
  DeviceLink(const DeviceLink&) = delete;
  DeviceLink& operator=(const DeviceLink&) = delete;
  ~DeviceLink();

  // Slow side. Errors: no thread.
  Status start();
  // Slow side, blocking: ends the threads, then takes the force away.
  void stop() noexcept;

  // Slow side: "OpenFFBoard, one axis: FFBoard, /dev/hidraw7".
  std::string description() const;

 private:
  void read_all() noexcept;
  void write_all() noexcept;
  void write(DeviceConnection& connection, const OutReports& reports) noexcept;
  void use(std::shared_ptr<DeviceConnection> connection) noexcept;
  std::shared_ptr<DeviceConnection> connection() noexcept;
  void look_again() noexcept;

  DeviceBus& bus_;
  LinkListener& listener_;
  DeviceNode info_;
  const DeviceProtocol& protocol_;
  std::mutex mutex_;  // of connection_; neither thread is the haptics thread
  std::shared_ptr<DeviceConnection> connection_;
  std::atomic<bool> stop_{false};
  std::thread reader_;
  std::thread writer_;
};

}  // namespace palpate
