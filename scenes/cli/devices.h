// The text of `palpate devices` about the connected devices. Thread guarantee: slow side (opens devices).
#pragma once

#include <string>

#include "devices/link/device_link.h"

namespace palpate::cli {

// Lists the devices on `bus`. Opens each supported one; if that fails, says why and how to fix it, with the udev rule
// in the folder `assets`.
std::string plugged_in_text(DeviceBus& bus, const std::string& assets);

}  // namespace palpate::cli
