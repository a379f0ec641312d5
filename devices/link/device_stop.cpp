#include "devices/link/device_stop.h"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <atomic>

#include "engine/base/signals.h"

namespace palpate {
namespace {

constexpr int kFree = -1, kReserved = -2;

struct Slot {
  std::atomic<int> descriptor{kFree};
  OutReports reports;  // fixed while descriptor >= 0
};
static_assert(std::atomic<int>::is_always_lock_free);
std::array<Slot, 8> slots;

// The number of unfinished writes of forces, and whether new ones are refused. Both are sequentially consistent: all
// threads see their changes in the same order.
std::atomic<int> writes_under_way{0};
std::atomic<bool> no_more_forces{false};
constexpr int kLongestWrite_ms = 20;  // several times the duration of a report on USB
// A child program is ended together with this one; before, it has to take the stop: three samples at 100 Hz.
constexpr int kTaken_ms = 30;

// Async-signal-safe.
void stop_all_devices() noexcept {
  no_more_forces.store(true);
  // The wait is bounded, because this handler may have interrupted the thread that writes.
  for (int i = 0; i < kLongestWrite_ms && writes_under_way.load() > 0; ++i) poll(nullptr, 0, 1);
  bool any = false;
  for (Slot& slot : slots) {
    const int descriptor = slot.descriptor.load(std::memory_order_acquire);
    if (descriptor < 0) continue;
    any = true;
    for (std::size_t i = 0; i < slot.reports.count; ++i) {
      // A signal handler cannot react to an error.
      [[maybe_unused]] const ssize_t written = ::write(descriptor, slot.reports.bytes[i].data(), slot.reports.sizes[i]);
    }
  }
  if (any) poll(nullptr, 0, kTaken_ms);
}

}  // namespace

int register_device_stop(int descriptor, const OutReports& reports) noexcept {
  stop_forces_by(stop_all_devices);
  install_signal_handlers();
  for (std::size_t i = 0; i < slots.size(); ++i) {
    int free = kFree;
    if (!slots[i].descriptor.compare_exchange_strong(free, kReserved)) continue;
    slots[i].reports = reports;
    slots[i].descriptor.store(descriptor, std::memory_order_release);
    return static_cast<int>(i);
  }
  return -1;
}

void unregister_device_stop(int slot) noexcept {
  if (slot >= 0) slots[static_cast<std::size_t>(slot)].descriptor.store(kFree, std::memory_order_release);
}

bool begin_force_write() noexcept {
  writes_under_way.fetch_add(1);
  if (!no_more_forces.load()) return true;
  end_force_write();
  return false;
}

void end_force_write() noexcept { writes_under_way.fetch_sub(1); }

}  // namespace palpate
