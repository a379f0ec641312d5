// Polhem / WoodenHaptics: int16 encoders a-f and int16 info in; int16 mA a-c, int16
// command, three int16 attributes out (14 bytes, little-endian). Axis a is used;
// units are mA.
#pragma once

#include "devices/hid/hid_driver.h"

namespace palpate {

extern const HidDriver kPolhemDriver;

}  // namespace palpate
