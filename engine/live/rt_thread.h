// Real-time scheduling of the calling thread, as far as the system permits, with advice where it does not. A refusal is
// never fatal.
#pragma once

#include <string>

namespace palpate {

struct RtRequest {
  // SCHED_FIFO priority, 1 to 99: above most threads, below the kernel's own 99.
  int priority = 80;
  bool lock_memory = true;
};

struct RtStatus {
  bool realtime = false;   // SCHED_FIFO obtained
  std::string scheduling;  // for reports: "SCHED_FIFO 80", "normal"
  std::string fix;         // advice; empty if nothing was refused
};

// The system calls, so that tests can refuse them. Each returns 0 or an errno value.
struct RtCalls {
  int (*set_fifo)(int priority);
  int (*lock_memory)();
  int (*set_timer_slack_1ns)();
  bool (*is_root)();
};
RtCalls system_rt_calls() noexcept;

// For the calling thread before its first tick: sets timer slack 1 ns (needs no privilege) and SCHED_FIFO, locks memory
// (of the whole process, pages on first use) and touches 256 KiB of stack. Blocking, allocates.
RtStatus make_this_thread_realtime(const RtRequest& request, const RtCalls& calls = system_rt_calls());

}  // namespace palpate
