// The haptic paddle: our own protocol, devices/hid/paddle_protocol.md. Units are mA.
#pragma once

#include "devices/hid/hid_driver.h"

namespace palpate {

extern const HidDriver kPaddleDriver;

}  // namespace palpate
