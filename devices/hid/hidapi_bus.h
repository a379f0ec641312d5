// The USB HID bus of this machine: libhidapi over hidraw.
// Each device is opened twice. hidapi reads from it. The writing thread uses a file of its own, because a handle of
// hidapi stores its last error without a lock. This file is also locked against a second program, and receives the stop
// report when a signal ends the program.
#pragma once

#include <array>

#include "devices/link/device_link.h"
#include "devices/link/device_protocol.h"

namespace palpate {

// The supported USB HID protocols (README.md says how to add one).
// Thread guarantee: slow side.

extern const DeviceProtocol kOpenFfBoardProtocol;
extern const DeviceProtocol kSpaceMouseProtocol;

// A node matches at most one of them.
inline constexpr std::array kHidProtocols = {
    &kOpenFfBoardProtocol,
    &kSpaceMouseProtocol,
};

// The protocol of `node`, by its ids; null: unknown.
inline const DeviceProtocol* hid_protocol_of(const DeviceNode& node) {
  for (const DeviceProtocol* protocol : kHidProtocols)
    if (protocol->matches(node)) return protocol;
  return nullptr;
}

class HidapiBus final : public DeviceBus {
 public:
  // `wait_ms`: longest wait of a read, ms; -1: unlimited, which emulated nodes of umockdev need.
  explicit HidapiBus(int wait_ms = 50) noexcept : wait_ms_(wait_ms) {}

  std::vector<DeviceNode> list() override;
  // Errors: no node, no permission (names the udev rule), in use by another program, or the system's message.
  Result<std::unique_ptr<DeviceConnection>> open(const DeviceNode& info) override;

 private:
  int wait_ms_;
};

// The bus of this program. Slow side, any thread.
DeviceBus& system_hid_bus();

// The message for an errno of opening a hidraw node, with what to do.
std::string open_error_words(const std::string& path, int error_number);

}  // namespace palpate
