// Passes values between two threads; neither waits for the other.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <type_traits>

namespace palpate {

// The newest value only: settings in, snapshots out. Values that are not read in time are lost.
// Three slots. The writer fills its own and exchanges it with the middle one; the reader exchanges its own with the
// middle one if that is newer. Values are never torn, and the reader never gets an older value than before.
template <typename T>
class TripleBuffer {
  static_assert(std::is_trivially_copyable_v<T>, "a copy must not allocate, lock or throw");
  static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

 public:
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

  // Reader thread. Wait-free. The value that `refresh` took last; before the first, T{}.
  const T& value() const noexcept { return slots_[front_].value; }

  // Reader thread. Wait-free. The newest value.
  const T& newest() noexcept {
    refresh();
    return value();
  }

 private:
  static constexpr std::uint32_t kFresh = 4, kIndex = 3;
  // Separate cache lines, so that the two threads do not slow each other down.
  struct alignas(64) Slot {
    T value{};
  };

  std::array<Slot, 3> slots_;
  alignas(64) std::atomic<std::uint32_t> middle_{1};
  alignas(64) std::uint32_t back_ = 0;   // of the writer
  alignas(64) std::uint32_t front_ = 2;  // of the reader
};

// Every value, in order: samples for plots and a recorder. When full, it drops and counts.
template <typename T, std::size_t N>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>, "a copy must not allocate, lock or throw");
  static_assert(N >= 2 && (N & (N - 1)) == 0, "a power of two");
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

 public:
  // Producer thread. Wait-free. False: full, dropped and counted.
  bool push(const T& value) noexcept {
    const std::uint64_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) == N) {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    values_[written & (N - 1)] = value;
    written_.store(written + 1, std::memory_order_release);
    return true;
  }

  // Consumer thread. Wait-free. False: empty, `value` is unchanged.
  bool pop(T& value) noexcept { return pop(&value, 1) == 1; }

  // Consumer thread. Wait-free, O(most). Pops up to `most` values, oldest first; returns their number.
  std::size_t pop(T* values, std::size_t most) noexcept {
    const std::uint64_t read = read_.load(std::memory_order_relaxed);
    const std::size_t count = std::min(size(), most);
    for (std::size_t i = 0; i < count; ++i) values[i] = values_[(read + i) & (N - 1)];
    read_.store(read + count, std::memory_order_release);
    return count;
  }

  // Consumer thread. Wait-free. The number of values in the ring.
  std::size_t size() const noexcept {
    return static_cast<std::size_t>(written_.load(std::memory_order_acquire) - read_.load(std::memory_order_relaxed));
  }

  // Any thread. Wait-free. The number of dropped values.
  std::uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::array<T, N> values_{};
  alignas(64) std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> dropped_{0};
  alignas(64) std::atomic<std::uint64_t> read_{0};
};

// A new set of models to the haptics thread, and the old one back.
// The slow side exchanges a new set into `pending_`; one that was never taken comes back and is deleted there. The tick
// takes the pending set only if the slow side has deleted the set that was retired before. It may continue to use the
// old one (to blend the force) and retires it later. The tick thus never deletes a set or waits.
template <typename T>
class ModelSlot {
  static_assert(std::atomic<T*>::is_always_lock_free);

 public:
  // Slow side, after all other threads have ended.
  ~ModelSlot() {
    collect();
    delete pending_.load(std::memory_order_acquire);
  }

  // One slow-side thread. Lock-free; may delete a set that was never taken. `next` is not null.
  void publish(std::unique_ptr<T> next) {
    collect();
    delete pending_.exchange(next.release(), std::memory_order_acq_rel);
  }

  // The same slow-side thread. Deletes the retired set; returns whether there was one.
  bool collect() { return std::unique_ptr<T>(retired_.exchange(nullptr, std::memory_order_acq_rel)) != nullptr; }

  // Haptics thread. Wait-free. The pending set; null if there is none or a retired set was not collected yet. The set
  // taken before must be retired before the next call.
  std::unique_ptr<T> acquire() noexcept {
    if (pending_.load(std::memory_order_relaxed) == nullptr) return nullptr;
    if (retired_.load(std::memory_order_acquire) != nullptr) return nullptr;
    return std::unique_ptr<T>(pending_.exchange(nullptr, std::memory_order_acq_rel));
  }

  // Haptics thread. Wait-free. Hands `old` over for deletion, at most one set after each that was acquired.
  void retire(std::unique_ptr<T> old) noexcept { retired_.store(old.release(), std::memory_order_release); }

 private:
  std::atomic<T*> pending_{nullptr};
  std::atomic<T*> retired_{nullptr};
};

}  // namespace palpate
