#include "engine/base/signals.h"

#include <signal.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <mutex>

namespace palpate {
namespace {

constexpr std::array<int, 10> kSignals = {SIGINT,  SIGTERM, SIGHUP, SIGQUIT, SIGPIPE,
                                          SIGSEGV, SIGBUS,  SIGFPE, SIGILL,  SIGABRT};
// The first of them may be requests to stop that the program handles itself.
constexpr std::size_t kRequests = 3;

struct sigaction before[kSignals.size()];
std::atomic<StopForces> stop_forces{nullptr};
std::atomic<bool> listening{false};
std::atomic<int> requested_by{0};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<StopForces>::is_always_lock_free,
              "read by a signal handler");

void pass_on(std::size_t index, int number, siginfo_t* info, void* context) noexcept {
  const struct sigaction& earlier = before[index];
  if ((earlier.sa_flags & SA_SIGINFO) != 0) {
    earlier.sa_sigaction(number, info, context);
  } else if (earlier.sa_handler != SIG_DFL) {
    earlier.sa_handler(number);
  } else {
    // The signal is delivered again, or its fault occurs again, when this handler returns.
    sigaction(number, &earlier, nullptr);
    raise(number);
  }
}

void on_signal(int number, siginfo_t* info, void* context) {
  const int saved_errno = errno;
  std::size_t index = 0;
  while (index + 1 < kSignals.size() && kSignals[index] != number) ++index;
  // The first request to stop is only stored while the program listens for it.
  int none = 0;
  if (!(index < kRequests && listening.load() && requested_by.compare_exchange_strong(none, number))) {
    if (const StopForces function = stop_forces.load(); function != nullptr) function();
    pass_on(index, number, info, context);
  }
  errno = saved_errno;
}

void own(std::size_t index) noexcept {
  struct sigaction current {};
  if (sigaction(kSignals[index], nullptr, &current) != 0) return;
  const bool informed = (current.sa_flags & SA_SIGINFO) != 0;
  if (informed ? current.sa_sigaction == on_signal : current.sa_handler == SIG_IGN) return;
  before[index] = current;
  struct sigaction action {};
  action.sa_sigaction = on_signal;
  // SA_RESTART: a request does not interrupt the reading of a file.
  action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_RESTART;
  sigfillset(&action.sa_mask);
  sigaction(kSignals[index], &action, nullptr);
}

}  // namespace

void install_signal_handlers() noexcept {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  for (std::size_t i = 0; i < kSignals.size(); ++i) own(i);
  signal(SIGXFSZ, SIG_IGN);
}

void ignore_broken_pipes() noexcept { signal(SIGPIPE, SIG_IGN); }

void stop_forces_by(StopForces function) noexcept { stop_forces.store(function); }

StopListener::StopListener() noexcept {
  requested_by.store(0);
  listening.store(true);
  install_signal_handlers();
}

StopListener::~StopListener() { listening.store(false); }

int stop_requested() noexcept { return requested_by.load(); }

}  // namespace palpate
