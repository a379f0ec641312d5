// What is plugged in, and one open device. The real bus is libhidapi (hidraw);
// tests have their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "devices/hid/hid_driver.h"
#include "engine/base/result.h"

namespace palpate {

// One open device. `read` belongs to one thread and `write` to one, at the same
// time if need be; the rest is slow side.
class HidConnection {
 public:
  virtual ~HidConnection() = default;
  // Blocking, for a while: the bytes of the next report; 0: none yet; below 0:
  // the device is gone.
  virtual int read(std::uint8_t* bytes, std::size_t capacity) noexcept = 0;
  // Blocking. False: the device did not take it.
  virtual bool write(const std::uint8_t* bytes, std::size_t size) noexcept = 0;
  // From now on `reports` go out when a signal ends the program, see device_stop.h.
  virtual void stop_with(const OutReports&) noexcept {}
};

class HidBus {
 public:
  virtual ~HidBus() = default;
  // Slow side. One entry per node.
  virtual std::vector<HidDeviceInfo> list() = 0;
  // Slow side. Errors: why not, and what to do.
  virtual Result<std::unique_ptr<HidConnection>> open(const HidDeviceInfo& info) = 0;
};

// None of them null.
using HidDrivers = std::vector<const HidDriver*>;

// The driver that `info` needs, by its ids; null: nothing that the program knows.
const HidDriver* matching_driver(const HidDeviceInfo& info);

// For `palpate devices`: every node, what it would be used as, and why not.
struct HidDiagnosis {
  HidDeviceInfo info;
  const HidDriver* driver = nullptr;  // null: it cannot be used
  std::string use;                    // in words
  std::string problem;                // with what to do; empty: it can be used, or is none of ours
};
std::vector<HidDiagnosis> diagnose(HidBus& bus);

}  // namespace palpate
