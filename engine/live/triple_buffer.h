// The newest value from one thread to another: settings in, snapshots out.
//
// Three slots. The writer fills the one that nobody sees and exchanges it with
// the middle one; the reader exchanges its own with the middle one when that
// is fresh. Neither ever waits for the other, a value is never half of one and
// half of the next, and a reader never goes back to an older one. Values that
// nobody read in time are lost: that is the point. Use SpscRing where every one
// counts.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace palpate {

template <typename T>
class TripleBuffer {
  static_assert(std::is_trivially_copyable_v<T>, "a copy must not allocate, lock or throw");
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

 public:
  // Slow side, before the threads: what a reader sees until the first write.
  explicit TripleBuffer(const T& first = T{}) noexcept {
    for (Slot& slot : slots_) slot.value = first;
  }
  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  // One writer thread. Wait-free: one copy and one exchange.
  void write(const T& value) noexcept {
    slots_[back_].value = value;
    back_ = middle_.exchange(back_ | kFresh, std::memory_order_acq_rel) & kIndex;
  }

  // One reader thread. Wait-free. Takes the newest value, if there is one that
  // was not taken yet; returns whether there was. `value` changes only here.
  bool refresh() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

  // Reader thread. Wait-free. What `refresh` took last.
  const T& value() const noexcept { return slots_[front_].value; }

  // Reader thread. Wait-free. The newest value there is.
  const T& newest() noexcept {
    refresh();
    return value();
  }

 private:
  static constexpr std::uint32_t kFresh = 4;
  static constexpr std::uint32_t kIndex = 3;
  // One cache line or more each, so that the two threads do not slow each other.
  struct alignas(64) Slot {
    T value;
  };

  std::array<Slot, 3> slots_;
  alignas(64) std::atomic<std::uint32_t> middle_{1};
  alignas(64) std::uint32_t back_ = 0;   // writer's
  alignas(64) std::uint32_t front_ = 2;  // reader's
};

}  // namespace palpate
