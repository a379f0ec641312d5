// 3Dconnexion's SpaceMouse: report 1 begins with three int16 translations; z is
// used, positive when pushed down. Nothing is ever written to it.
#pragma once

#include "devices/hid/hid_driver.h"

namespace palpate {

extern const HidDriver kSpaceMouseDriver;

}  // namespace palpate
