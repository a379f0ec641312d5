// The protocols that the program speaks. A new one is a file in devices/hid/protocol/
// and two lines here (and its calibration in assets/devices/).
#pragma once

#include <array>
#include <string_view>

#include "devices/hid/hid_driver.h"

namespace palpate {

extern const HidDriver kOpenFfBoardDriver;
extern const HidDriver kSpaceMouseDriver;
extern const HidDriver kBridgeDriver;

// A node has the ids of one of them at most.
inline constexpr std::array kHidDrivers = {
    &kOpenFfBoardDriver,
    &kSpaceMouseDriver,
    &kBridgeDriver,
};

// What the path of a node of a BridgeBus begins with, and no other does.
inline constexpr std::string_view kBridgePath = "bridge:";

}  // namespace palpate
