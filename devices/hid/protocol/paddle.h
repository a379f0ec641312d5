// The haptic paddle: our own protocol, devices/hid/paddle_protocol.md. Units are mA.
#pragma once

#include "devices/hid/hid_driver.h"

namespace palpate {

extern const HidDriver kPaddleDriver;

// The boards of the paddle and of Polhem: a Teensy with its raw HID interface (its
// other interface is for messages to a console).
bool is_raw_hid_teensy(const HidDeviceInfo& info) noexcept;

}  // namespace palpate
