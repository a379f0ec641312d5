// The frames of `--device bridge:TARGET` (devices/firmware/bridge_protocol.h), one
// a report, as a BridgeBus finds them in a stream of bytes. A count is 1 nm, a unit 1 uN
// towards growing positions.
#pragma once

#include <string_view>

#include "devices/hid/hid_driver.h"

namespace palpate {

// What the path of a node of a BridgeBus begins with, and no other does.
inline constexpr std::string_view kBridgePath = "bridge:";

extern const HidDriver kBridgeDriver;

}  // namespace palpate
