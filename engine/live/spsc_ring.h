// Passes every value in order from one thread to another: samples for plots and recorder, models to be deleted. When
// the ring is full a new value is dropped and counted; the writer never waits.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace palpate {

template <typename T, std::size_t N>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>, "a copy must not allocate, lock or throw");
  static_assert(N >= 2 && (N & (N - 1)) == 0, "a power of two");
  static_assert(std::atomic<std::uint64_t>::is_always_lock_free);

 public:
  SpscRing() = default;
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  // Producer thread. Wait-free. False: full, dropped and counted.
  bool push(const T& value) noexcept {
    const std::uint64_t written = written_.load(std::memory_order_relaxed);
    if (!room_for(written)) {
      dropped_.store(dropped_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      return false;
    }
    values_[written & (N - 1)] = value;
    written_.store(written + 1, std::memory_order_release);
    return true;
  }

  // Producer thread. Wait-free. Whether the next push will succeed; only a push can change true to false.
  bool has_room() noexcept { return room_for(written_.load(std::memory_order_relaxed)); }

  // Consumer thread. Wait-free. False: empty, `value` is unchanged.
  bool pop(T& value) noexcept { return pop(&value, 1) == 1; }

  // Consumer thread. Wait-free, O(most). Pops up to `most` values, oldest first; returns their number.
  std::size_t pop(T* values, std::size_t most) noexcept {
    const std::uint64_t read = read_.load(std::memory_order_relaxed);
    const std::uint64_t ready = written_.load(std::memory_order_acquire) - read;
    const std::size_t count = ready < most ? static_cast<std::size_t>(ready) : most;
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
  bool room_for(std::uint64_t written) noexcept {
    if (written - seen_read_ < N) return true;
    seen_read_ = read_.load(std::memory_order_acquire);
    return written - seen_read_ < N;
  }

  std::array<T, N> values_{};
  alignas(64) std::atomic<std::uint64_t> written_{0};
  std::uint64_t seen_read_ = 0;  // the producer's last reading of read_
  std::atomic<std::uint64_t> dropped_{0};
  alignas(64) std::atomic<std::uint64_t> read_{0};
};

}  // namespace palpate
