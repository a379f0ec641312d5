// Sends the stop report to every open device when a signal ends the program. This does not cover SIGKILL, a power
// failure or a hung system. When the host is silent, working firmware removes the force:
//   bridge       50 ms after the last valid frame or change of the heartbeat
//   OpenFFBoard  50 ms after the host last restarted its effect (devices/hid/openffboard.cpp)
//   SpaceMouse   renders no force
// Firmware that hangs while it drives the motor is not covered.
#pragma once

#include "devices/link/device_protocol.h"

namespace palpate {

// Slow side. `reports` are written to `descriptor`, which stays open until `unregister_device_stop`. Returns the slot;
// -1 when all eight are in use.
int register_device_stop(int descriptor, const OutReports& reports) noexcept;
// Slow side. -1 is ignored.
void unregister_device_stop(int slot) noexcept;

// Call them around every write of a report that may have a force. Any thread, wait-free. False: a signal is ending the
// program; do not write, and report the write as failed. Else call `end_force_write` afterwards.
bool begin_force_write() noexcept;
void end_force_write() noexcept;

// Async-signal-safe: blocks new force writes, waits for running ones (at most 20 ms), then writes all registered
// reports as the last ones.
void stop_all_devices() noexcept;

// Slow side, may be called repeatedly: handles the signals (signals.h) so that all devices stop before one of them ends
// the program. LinkedDevice::open calls it.
void stop_devices_on_signals() noexcept;

}  // namespace palpate
