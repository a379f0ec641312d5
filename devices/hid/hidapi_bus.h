// The real bus: libhidapi over hidraw.
//
// Each device is opened three times: once for the thread that reads and once for
// the one that writes, because a handle of hidapi keeps its last error unguarded;
// and once plainly, to hold the lock that keeps a second program from pushing
// the same tool, and for the last report when a signal ends the program.
#pragma once

#include "devices/link/device_bus.h"

namespace palpate {

class HidapiBus final : public DeviceBus {
 public:
  // `wait_ms`: how long a read waits for a report; -1: until one comes (an emulated
  // node of umockdev can only be read so).
  explicit HidapiBus(int wait_ms = 50) noexcept : wait_ms_(wait_ms) {}

  std::vector<DeviceNode> list() override;
  // Errors: no node, no permission (with the udev rule), in use by another program,
  // or what the system says.
  Result<std::unique_ptr<DeviceConnection>> open(const DeviceNode& info) override;

 private:
  int wait_ms_;
};

// The one of the program. Slow side, any thread.
DeviceBus& system_hid_bus();

// What to do about an errno of opening a hidraw node, in words.
std::string open_error_words(const std::string& path, int error_number);

}  // namespace palpate
