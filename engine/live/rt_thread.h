// Real-time scheduling of the calling thread, as far as the system permits, with advice where it does not. A refusal is
// never fatal.
#pragma once

#include <string>

namespace palpate {

struct RtStatus {
  bool realtime = false;   // SCHED_FIFO obtained
  std::string scheduling;  // for reports: "SCHED_FIFO 80", "normal"
  std::string fix;         // advice; empty if nothing was refused
};

// The advice for refused requests, empty without one. The errors are errno values, 0 if granted.
std::string realtime_advice(int priority_error, int memory_error, bool is_root);

// Sets the timer slack of the calling thread to 1 ns (default: 50 us), so that sleeps end on time. Needs no privilege.
void set_timer_slack_1ns() noexcept;

// For the calling thread before its first tick: sets timer slack 1 ns and SCHED_FIFO with `priority`, 1 to 99 (the
// default is above most threads and below the kernel's own 99), locks memory (of the whole process, pages on first use)
// and touches 256 KiB of stack. Blocking, allocates.
RtStatus make_this_thread_realtime(int priority = 80, bool lock_memory = true);

}  // namespace palpate
