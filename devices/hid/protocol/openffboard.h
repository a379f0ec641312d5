// OpenFFBoard: vendor report 0xA1, 25 bytes: type u8, class u16, instance u8, command
// u32, data u64, address u64; firmware in its mode "HID Gamepad (Ext FFB)": position
// of axis 0, one constant force in 1/32767 of full force.
// Source: its published list of commands.
#pragma once

#include "devices/hid/hid_driver.h"

namespace palpate {

extern const HidDriver kOpenFfBoardDriver;

}  // namespace palpate
