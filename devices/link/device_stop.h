// The last report of every open device when a signal ends the program: no force.
// No handler covers SIGKILL, a power cut or a hung system. A device whose host falls
// silent takes its force away by itself, as far as its firmware lives:
//   bridge       50 ms after the last valid frame or beat of the haptics thread
//   OpenFFBoard  50 ms after the host last started its effect anew (protocol/openffboard.cpp)
//   SpaceMouse   has no force
// Nothing here covers firmware that hangs while its motor is driven.
#pragma once

#include "devices/link/device_protocol.h"

namespace palpate {

// Slow side. `descriptor` stays open until `unregister_device_stop`; `reports` are
// written to it as they are. Returns the slot, -1 when all eight are taken.
int register_device_stop(int descriptor, const OutReports& reports) noexcept;
// Slow side. -1 is ignored.
void unregister_device_stop(int slot) noexcept;

// Around every report that may carry a force, in any thread; wait-free. False: a signal
// ends the program, nothing but the stop may be written any more, and the write counts
// as refused. Otherwise `end_force_write` follows.
bool begin_force_write() noexcept;
void end_force_write() noexcept;

// Async-signal-safe: lets writes that are under way finish (20 ms at most), lets no
// other begin, then writes all registered reports: nothing comes after them.
void stop_all_devices() noexcept;

// Slow side, any number of times: owns the signals (signals.h), and all devices stop
// before one of them ends the program. Opening a device that pushes calls it.
void stop_devices_on_signals() noexcept;

}  // namespace palpate
