// The supported USB HID protocols (README.md says how to add one).
// Thread guarantee: slow side.
#pragma once

#include <array>

#include "devices/link/device_protocol.h"

namespace palpate {

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

}  // namespace palpate
