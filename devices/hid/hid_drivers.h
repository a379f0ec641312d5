// The protocols that the program speaks. A new one is a file in devices/hid/protocol/
// and a line here (and its calibration in assets/devices/).
#pragma once

#include <array>

#include "devices/hid/protocol/openffboard.h"
#include "devices/hid/protocol/paddle.h"
#include "devices/hid/protocol/polhem.h"
#include "devices/hid/protocol/spacemouse.h"

namespace palpate {

// Where reports fit two, the first one counts.
inline constexpr std::array kHidDrivers = {
    &kPaddleDriver,
    &kPolhemDriver,
    &kOpenFfBoardDriver,
    &kSpaceMouseDriver,
};

}  // namespace palpate
