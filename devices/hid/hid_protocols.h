// The protocols on a USB port that the program speaks. A new one is a file here and two lines below (and its
// calibration in assets/devices/). Thread guarantee: slow side.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "devices/link/device_bus.h"

namespace palpate {

extern const DeviceProtocol kOpenFfBoardProtocol;
extern const DeviceProtocol kSpaceMouseProtocol;

// A node has the ids of one of them at most.
inline constexpr std::array kHidProtocols = {
    &kOpenFfBoardProtocol,
    &kSpaceMouseProtocol,
};

// The protocol that `node` needs, by its ids; null: nothing that the program knows.
const DeviceProtocol* hid_protocol_of(const DeviceNode& node);

// For `palpate devices`: every node, what it would be used as, and why not.
struct HidDiagnosis {
  DeviceNode node;
  const DeviceProtocol* protocol = nullptr;  // null: it cannot be used
  std::string use;                           // in words
  std::string problem;                       // with what to do; empty: it can be used, or is none of ours
};
std::vector<HidDiagnosis> diagnose(DeviceBus& bus);

}  // namespace palpate
