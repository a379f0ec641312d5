// Interfaces of a bus, which lists devices and opens them, and of an open device. A bus is USB HID (devices/hid), a
// byte stream (devices/bridge), or a test double.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
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
  // The file to which the stop report is written when a signal ends the program (device_stop.h); -1: none.
  virtual int descriptor() const noexcept { return -1; }
};

class DeviceBus {
 public:
  virtual ~DeviceBus() = default;
  // Slow side. One entry per node.
  virtual std::vector<DeviceNode> list() = 0;
  // Slow side. Errors: the node cannot be opened; with the reason and what to do.
  virtual Result<std::unique_ptr<DeviceConnection>> open(const DeviceNode& node) = 0;
};

}  // namespace palpate
