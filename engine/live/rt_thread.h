// Real-time scheduling for the calling thread, as far as the system permits,
// and in words what to do where it does not. Nothing here is ever fatal.
#pragma once

#include <string>

namespace palpate {

struct RtRequest {
  // SCHED_FIFO priority, 1 to 99: above most interrupt threads' users, below the
  // kernel's own 99.
  int priority = 80;
  bool lock_memory = true;
};

struct RtStatus {
  bool realtime = false;   // SCHED_FIFO obtained
  std::string scheduling;  // for people and --stats: "SCHED_FIFO 80", "normal"
  std::string fix;         // what to do for more; empty when nothing was refused
};

// The system calls behind it, so that a test can refuse them. Each returns 0 or
// an errno value.
struct RtCalls {
  int (*set_fifo)(int priority);
  int (*lock_memory)();
  int (*set_timer_slack_1ns)();
  bool (*is_root)();
};
RtCalls system_rt_calls() noexcept;

// For the calling thread, before its first tick: timer slack 1 ns (needs no
// privilege), SCHED_FIFO, locked memory (the whole process, pages as they come
// into use), 256 KiB of stack touched. Blocking, allocates.
RtStatus make_this_thread_realtime(const RtRequest& request, const RtCalls& calls = system_rt_calls());

}  // namespace palpate
