// The one owner of the process's signals.
//
// SIGINT, SIGTERM and SIGHUP end the program, as do SIGQUIT, SIGPIPE and the signals
// of a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT); before any of them does, forces
// go to zero. While a StopListener exists, the first SIGINT, SIGTERM or SIGHUP only sets a
// flag, so that the program ends in its own order and removes what it made; the second, of
// whatever kind, ends it at once. A signal that is ignored stays ignored, and a handler that
// was installed before is called after the forces are gone. Nothing runs on SIGKILL or a
// power cut; what becomes of the force then, devices/link/device_stop.h says for each device.
#pragma once

namespace palpate {

// Async-signal-safe: no allocation, no lock, no stdio. May run in two threads at once.
using StopForces = void (*)() noexcept;

// Slow side, any number of times: main, before the first thread, and whoever opens a
// device. A file that outgrows the process's size limit becomes an error of its write.
// Errors: none; what the system refuses stays as it was.
void own_signals() noexcept;
// A pipe that closes is an error of the write, and does not end the program.
void ignore_broken_pipes() noexcept;

// Slow side: from now on `function` runs before a signal ends the program; one at a time.
// Owns no signal.
void stop_forces_by(StopForces function) noexcept;

// Slow side; one at a time. Owns the signals; forgets what an earlier one was asked.
class StopListener {
 public:
  StopListener() noexcept;
  StopListener(const StopListener&) = delete;
  StopListener& operator=(const StopListener&) = delete;
  ~StopListener();
};

// Any thread, wait-free: the signal that asked the program to stop during the newest
// StopListener; 0: none did.
int stop_requested() noexcept;

}  // namespace palpate
