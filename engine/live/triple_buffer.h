// Passes the newest value from one thread to another: settings in, snapshots out.
//
// Three slots. The writer fills its own and exchanges it with the middle one; the reader exchanges its own with the
// middle one if that is newer. Neither waits for the other, values are never torn, and the reader never gets an older
// value than before. Values that were not read in time are lost; use SpscRing where every value matters.
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
  // Slow side, before the threads start. `first`: the value before the first write.
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

  // One reader thread. Wait-free. Takes the newest value if it was not taken yet; returns whether there was one. Only
  // this changes `value`.
  bool refresh() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & kIndex;
    return true;
  }

  // Reader thread. Wait-free. The value that `refresh` took last.
  const T& value() const noexcept { return slots_[front_].value; }

  // Reader thread. Wait-free. The newest value.
  const T& newest() noexcept {
    refresh();
    return value();
  }

 private:
  static constexpr std::uint32_t kFresh = 4;
  static constexpr std::uint32_t kIndex = 3;
  // Separate cache lines, so that the two threads do not slow each other down.
  struct alignas(64) Slot {
    T value;
  };

  std::array<Slot, 3> slots_;
  alignas(64) std::atomic<std::uint32_t> middle_{1};
  alignas(64) std::uint32_t back_ = 0;   // of the writer
  alignas(64) std::uint32_t front_ = 2;  // of the reader
};

}  // namespace palpate
