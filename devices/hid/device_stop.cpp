#include "devices/hid/device_stop.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <mutex>

namespace palpate {
namespace {

constexpr std::size_t kSlots = 8;

struct Slot {
  std::atomic<int> descriptor{-1};
  std::atomic<bool> taken{false};
  OutReports reports;  // fixed while descriptor >= 0
};
static_assert(std::atomic<int>::is_always_lock_free);
std::array<Slot, kSlots> slots;

constexpr std::array<int, 10> kSignals = {SIGINT,  SIGTERM, SIGHUP, SIGQUIT, SIGPIPE,
                                          SIGSEGV, SIGBUS,  SIGFPE, SIGILL,  SIGABRT};
struct sigaction before[kSignals.size()];

void on_signal(int signal, siginfo_t* info, void* context) {
  const int saved_errno = errno;
  stop_all_devices();
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    if (kSignals[i] != signal) continue;
    if ((before[i].sa_flags & SA_SIGINFO) != 0 && before[i].sa_sigaction != nullptr) {
      before[i].sa_sigaction(signal, info, context);
    } else if (before[i].sa_handler == SIG_DFL) {
      // Comes again, or happens again, when this handler returns.
      sigaction(signal, &before[i], nullptr);
      raise(signal);
    } else if (before[i].sa_handler != SIG_IGN) {
      before[i].sa_handler(signal);
    }
  }
  errno = saved_errno;
}

}  // namespace

int register_device_stop(int descriptor, const OutReports& reports) noexcept {
  for (std::size_t i = 0; i < kSlots; ++i) {
    if (slots[i].taken.exchange(true)) continue;
    slots[i].reports = reports;
    slots[i].descriptor.store(descriptor, std::memory_order_release);
    return static_cast<int>(i);
  }
  return -1;
}

void unregister_device_stop(int slot) noexcept {
  if (slot < 0) return;
  Slot& one = slots[static_cast<std::size_t>(slot)];
  one.descriptor.store(-1, std::memory_order_release);
  one.taken.store(false, std::memory_order_release);
}

void stop_all_devices() noexcept {
  for (Slot& slot : slots) {
    const int descriptor = slot.descriptor.load(std::memory_order_acquire);
    if (descriptor < 0) continue;
    for (std::size_t i = 0; i < slot.reports.count; ++i) {
      // Whether it arrives or not, there is nothing else to do here.
      [[maybe_unused]] const ssize_t written =
          ::write(descriptor, slot.reports.bytes[i].data(), slot.reports.sizes[i]);
    }
  }
}

void stop_devices_on_signals() noexcept {
  static std::once_flag once;
  std::call_once(once, [] {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      if (sigaction(kSignals[i], nullptr, &before[i]) != 0) continue;
      const bool plain = (before[i].sa_flags & SA_SIGINFO) == 0;
      if (plain && before[i].sa_handler == SIG_IGN) continue;
      struct sigaction action {};
      action.sa_sigaction = on_signal;
      action.sa_flags = SA_SIGINFO | SA_ONSTACK | (before[i].sa_flags & SA_RESTART);
      action.sa_mask = before[i].sa_mask;
      sigaction(kSignals[i], &action, nullptr);
    }
  });
}

}  // namespace palpate
