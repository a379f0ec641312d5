// OpenFFBoard: vendor report 0xA1, 25 bytes: type u8, class u16, instance u8, command
// u32, data u64, address u64; firmware in its mode "HID Gamepad (Ext FFB)": position
// of axis 0, one constant force in 1/32767 of full force. The force ends 50 ms after the
// host last renewed it; firmware that does not know durations refuses the command, which
// counts as a fault of the device.
// Source: its published list of commands and the source of its effects manager.
#pragma once

#include "devices/hid/hid_driver.h"

namespace palpate {

extern const HidDriver kOpenFfBoardDriver;

}  // namespace palpate
