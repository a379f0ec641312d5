// Hands a new set of models to the haptics thread, and the old one back.
//
// The slow side builds, checks and warms a set, then exchanges it into `pending_`; a set that was never taken comes
// back and is deleted there. The tick takes the pending set at its boundary, but only if the retire ring has room for
// the old one, which it may continue to use (to blend the force) and retires later. The slow side deletes the sets in
// the ring. The tick thus never deletes a set or waits.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>

#include "engine/live/spsc_ring.h"

namespace palpate {

template <typename T>
class ModelSlot {
  static_assert(std::atomic<T*>::is_always_lock_free);

 public:
  ModelSlot() = default;
  ModelSlot(const ModelSlot&) = delete;
  ModelSlot& operator=(const ModelSlot&) = delete;
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

  // The same slow-side thread. Deletes the retired sets; returns their number.
  std::size_t collect() {
    std::size_t count = 0;
    for (T* old = nullptr; retired_.pop(old); ++count) delete old;
    return count;
  }

  // Haptics thread. Wait-free. The pending set, owned by the caller until `retire`; null if there is none or the ring
  // has no room. Besides the newest set, at most one taken set may be waiting for its `retire`.
  T* acquire() noexcept {
    if (pending_.load(std::memory_order_relaxed) == nullptr || !retired_.has_room()) return nullptr;
    return pending_.exchange(nullptr, std::memory_order_acq_rel);
  }

  // Haptics thread. Wait-free. Hands `old` over for deletion. There is room: `acquire` checked it, and no other
  // function fills the ring.
  void retire(T* old) noexcept { retired_.push(old); }

 private:
  std::atomic<T*> pending_{nullptr};
  SpscRing<T*, 8> retired_;
};

}  // namespace palpate
