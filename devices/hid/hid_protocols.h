// The supported USB HID protocols (README.md says how to add one).
// Thread guarantee: slow side.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "devices/link/device_bus.h"

namespace palpate {

extern const DeviceProtocol kOpenFfBoardProtocol;
extern const DeviceProtocol kSpaceMouseProtocol;

// A node matches at most one of them.
inline constexpr std::array kHidProtocols = {
    &kOpenFfBoardProtocol,
    &kSpaceMouseProtocol,
};

// The protocol of `node`, by its ids; null: unknown.
const DeviceProtocol* hid_protocol_of(const DeviceNode& node);

// For `palpate devices`: whether a node is supported and can be opened.
struct HidDiagnosis {
  DeviceNode node;
  std::string use;      // description of the protocol, or "not supported"
  std::string problem;  // why it cannot be opened and what to do; else empty
};
std::vector<HidDiagnosis> diagnose(DeviceBus& bus);

}  // namespace palpate
