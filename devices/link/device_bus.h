// What is plugged in, and one open device, whatever brings its reports: USB HID (devices/hid), a stream of bytes
// (devices/bridge), or a test's own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "devices/link/device_protocol.h"
#include "engine/base/result.h"

namespace palpate {

// One open device. `read` belongs to one thread and `write` to one, at the same time if need be; the rest is slow side.
class DeviceConnection {
 public:
  virtual ~DeviceConnection() = default;
  // Blocking, for a while: the bytes of the next report; 0: none yet; below 0: the device is gone.
  virtual int read(std::uint8_t* bytes, std::size_t capacity) noexcept = 0;
  // Blocking. False: the device did not take it.
  virtual bool write(const std::uint8_t* bytes, std::size_t size) noexcept = 0;
  // From now on `reports` go out when a signal ends the program, see device_stop.h.
  virtual void stop_with(const OutReports&) noexcept {}
};

class DeviceBus {
 public:
  virtual ~DeviceBus() = default;
  // Slow side. One entry per node.
  virtual std::vector<DeviceNode> list() = 0;
  // Slow side. Errors: why not, and what to do.
  virtual Result<std::unique_ptr<DeviceConnection>> open(const DeviceNode& node) = 0;
};

}  // namespace palpate
