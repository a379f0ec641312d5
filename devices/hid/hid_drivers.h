// The protocols that the program speaks. A new one is a file in devices/hid/protocol/
// and a line here (and its calibration in assets/devices/).
#pragma once

#include <array>

#include "devices/hid/protocol/bridge.h"
#include "devices/hid/protocol/openffboard.h"
#include "devices/hid/protocol/spacemouse.h"

namespace palpate {

// A node has the ids of one of them at most.
inline constexpr std::array kHidDrivers = {
    &kOpenFfBoardDriver,
    &kSpaceMouseDriver,
    &kBridgeDriver,
};

}  // namespace palpate
