// The last report of every open device when a signal ends the program: no force.
// The device's own watchdog covers what no handler can: SIGKILL, a power cut.
#pragma once

#include "devices/hid/hid_driver.h"

namespace palpate {

// Slow side. `descriptor` stays open until `unregister_device_stop`; `reports` are
// written to it as they are. Returns the slot, -1 when all eight are taken.
int register_device_stop(int descriptor, const OutReports& reports) noexcept;
// Slow side. -1 is ignored.
void unregister_device_stop(int slot) noexcept;

// Any thread, also in a signal handler: writes all registered reports.
void stop_all_devices() noexcept;

// Slow side, any number of times: SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE and the
// signals of a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) first stop all
// devices, then do what they did before. A signal that is ignored stays ignored.
// Opening a device that pushes calls it; a handler that is installed later has to
// call stop_all_devices itself.
void stop_devices_on_signals() noexcept;

}  // namespace palpate
