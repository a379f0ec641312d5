// The one owner of the process's signals.
//
// SIGINT, SIGTERM and SIGHUP end the program, as do SIGQUIT, SIGPIPE and the signals
// of a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT); before any of them does, the
// clean-ups run: forces to zero first, then temporary files. While a StopListener
// exists, the first SIGINT, SIGTERM or SIGHUP only sets a flag, so that the program
// ends in its own order; the second, of whatever kind, ends it at once, with the
// clean-ups. A signal that is ignored stays ignored, and a handler that was installed
// before is called after the clean-ups. Nothing runs on SIGKILL or a power cut; what
// becomes of the force then, devices/hid/device_stop.h says for each device.
#pragma once

namespace palpate {

// In the order in which they run.
enum class CleanUp { stop_forces, remove_files };

// Async-signal-safe: no allocation, no lock, no stdio. May run in two threads at once.
using CleanUpFunction = void (*)() noexcept;

// Slow side, any number of times: main, before the first thread, and whoever opens a
// device. A file that outgrows the process's size limit becomes an error of its write.
// Errors: none; what the system refuses stays as it was.
void own_signals() noexcept;
// A pipe that closes is an error of the write, and does not end the program.
void ignore_broken_pipes() noexcept;

// Slow side: from now on `function` is the clean-up of that kind, one each. Owns no
// signal: a library that is asked for a file does not touch its program's handlers.
void set_clean_up(CleanUp kind, CleanUpFunction function) noexcept;

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
