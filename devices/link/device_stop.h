// Sends the stop report to every open device when a signal ends the program. This does not cover SIGKILL, a power
// failure or a hung system. When the host is silent, working firmware removes the force:
//   bridge       50 ms after the last valid frame or change of the heartbeat
//   OpenFFBoard  50 ms after the host last restarted its effect (devices/hid/openffboard.cpp)
//   SpaceMouse   renders no force
// Firmware that hangs while it drives the motor is not covered.
#pragma once

#include "devices/link/device_protocol.h"

namespace palpate {

// Any thread but the haptics thread; installs the handlers of signals.h. When one of its signals ends the program, new
// writes of forces are refused, running ones get 20 ms to finish, `reports` are written to `descriptor`, which must
// stay open until `unregister_device_stop`, and the devices get 30 ms to take them. Returns the slot; -1 when all eight
// are in use.
int register_device_stop(int descriptor, const OutReports& reports) noexcept;
// Any thread but the haptics thread. -1 is ignored.
void unregister_device_stop(int slot) noexcept;

// To be called around every write of a report that may have a force. Any thread, wait-free. False: a signal is ending
// the program; do not write, and report the write as failed. True: call `end_force_write` after the write.
bool begin_force_write() noexcept;
void end_force_write() noexcept;

}  // namespace palpate
