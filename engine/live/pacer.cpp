#include "engine/live/pacer.h"

#include <linux/capability.h>
#include <pthread.h>
#include <pwd.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace palpate {
namespace {

constexpr std::size_t kStackBytes = 256 * 1024;

// Under a limit, locking future memory would make a later allocation fail anywhere in the program, which is worse than
// not locking.
int lock_all_memory() {
  rlimit limit{};
  const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct sets[_LINUX_CAPABILITY_U32S_3] = {};
  const bool capable = syscall(SYS_capget, &header, sets) == 0 && (sets[0].effective >> CAP_IPC_LOCK & 1U) != 0;
  if (!unlimited && !capable) return EPERM;
  return mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0 ? 0 : errno;
}

// Maps the pages of the stack before the first deep call of a tick.
void touch_stack() {
  std::array<char, kStackBytes> pages;
  volatile char* first = pages.data();
  for (std::size_t i = 0; i < kStackBytes; i += 1024) first[i] = 0;
}

}  // namespace

std::string realtime_advice(int priority_error, int memory_error, bool is_root) {
  std::string refused;
  if (priority_error != 0) refused = std::string("real-time priority (") + std::strerror(priority_error) + ")";
  if (memory_error != 0)
    refused += std::string(refused.empty() ? "" : " and ") + "locked memory (" + std::strerror(memory_error) + ")";
  if (refused.empty()) return {};
  if (is_root) {
    return refused +
           " refused by the container although this is root; start the container with "
           "--cap-add=SYS_NICE --cap-add=IPC_LOCK --ulimit rtprio=99 --ulimit memlock=-1";
  }
  std::array<char, 4096> text;
  passwd entry{};
  passwd* found = nullptr;
  getpwuid_r(geteuid(), &entry, text.data(), text.size(), &found);
  const std::string user = found != nullptr ? entry.pw_name : "USER";
  std::error_code unreadable;
  const std::string program = std::filesystem::read_symlink("/proc/self/exe", unreadable);
  return refused + " refused; either add these two lines to /etc/security/limits.conf and log in again:\n  " + user +
         " - rtprio 90\n  " + user + " - memlock unlimited\nor run: sudo setcap cap_sys_nice,cap_ipc_lock=ep " +
         (unreadable ? "PROGRAM" : program);
}

void set_timer_slack_1ns() noexcept { prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL); }

RtStatus make_this_thread_realtime(int priority, bool lock_memory) {
  RtStatus status;
  set_timer_slack_1ns();
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int priority_error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  status.realtime = priority_error == 0;
  status.scheduling = status.realtime ? "SCHED_FIFO " + std::to_string(priority) : "normal";
  status.fix = realtime_advice(priority_error, lock_memory ? lock_all_memory() : 0, geteuid() == 0);
  touch_stack();
  return status;
}

constexpr std::int64_t kNsPerS = 1'000'000'000;

std::int64_t steady_now_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * kNsPerS + now.tv_nsec;
}

void SteadyPacer::wait_until(std::int64_t deadline_ns) noexcept {
  const timespec until{deadline_ns / kNsPerS, deadline_ns % kNsPerS};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

void SteadyPacer::spin_until(std::int64_t deadline_ns) noexcept {
  while (now_ns() < deadline_ns) {
  }
}

TimePercentiles TimeHistogram::percentiles() const noexcept {
  constexpr double kUsPerNs = 1e-3;
  TimePercentiles result;
  std::array<std::uint64_t, kBins> cumulative;
  for (std::size_t i = 0; i < kBins; ++i) cumulative[i] = result.count += counts_[i].load(std::memory_order_relaxed);
  if (result.count == 0) return result;
  const std::uint64_t longest_ns = longest_ns_.load(std::memory_order_relaxed);
  // Nearest rank, from below.
  const auto at = [&](double share) {
    const auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(result.count)));
    const auto bin = static_cast<std::size_t>(std::ranges::lower_bound(cumulative, rank) - cumulative.begin());
    return kUsPerNs * static_cast<double>(std::min(top_of(bin), longest_ns));
  };
  result.p50_us = at(0.5);
  result.p99_us = at(0.99);
  result.p99_9_us = at(0.999);
  result.max_us = kUsPerNs * static_cast<double>(longest_ns);
  return result;
}

}  // namespace palpate
