// Handles all signals of the process: SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE and those of a crash end the program
// after the forces were set to zero. While a StopListener exists, the first SIGINT, SIGTERM or SIGHUP only sets a flag,
// so that the program can end regularly; a second one ends it at once. An ignored signal stays ignored, and an earlier
// handler is called after the forces are zero. devices/link/device_link.h describes SIGKILL and a power cut.
#pragma once

namespace palpate {

// Async-signal-safe: no allocation, no lock, no stdio. May run in two threads at once.
using StopForces = void (*)() noexcept;

// Installs the handlers. Slow side, any number of times: in main before the first thread, and when a device is opened.
// Ignores SIGXFSZ, so that a write beyond the limit of file sizes is an error. A refused handler is skipped.
void install_signal_handlers() noexcept;
// Makes a write to a closed pipe an error instead of the end of the program.
void ignore_broken_pipes() noexcept;

// Slow side: sets the function that runs before a signal ends the program, in place of the last one; null: none.
void stop_forces_by(StopForces function) noexcept;

// Slow side; one at a time. Installs the handlers and resets `stop_requested`.
class StopListener {
 public:
  StopListener() noexcept;
  StopListener(const StopListener&) = delete;
  StopListener& operator=(const StopListener&) = delete;
  ~StopListener();
};

// Any thread, wait-free: the signal that requested a stop during the newest StopListener; 0: none.
int stop_requested() noexcept;

}  // namespace palpate
