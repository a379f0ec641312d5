// A new set of models into the haptics thread, and the old one out of it.
//
// The slow side builds, checks and warms a set, then exchanges it into
// `pending_`; a set that was never taken comes back and is deleted there. The
// tick takes the pending set at its boundary, but only when the retire ring has
// room for the one it will give up: it may go on using that one (to blend the
// force) and retires it when it is done with it. The slow side deletes what it
// finds in the ring. So nothing is ever deleted, or waited for, in the tick.
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
  // Slow side, when no other thread is left.
  ~ModelSlot() {
    collect();
    delete pending_.load(std::memory_order_acquire);
  }

  // One slow-side thread. Lock-free towards the tick; may delete a set that was
  // never taken. `next` is not null.
  void publish(std::unique_ptr<T> next) {
    collect();
    delete pending_.exchange(next.release(), std::memory_order_acq_rel);
  }

  // The same slow-side thread. Deletes what the tick has retired; returns how
  // many.
  std::size_t collect() {
    std::size_t count = 0;
    for (T* old = nullptr; retired_.pop(old); ++count) delete old;
    return count;
  }

  // Haptics thread. Wait-free. The pending set, now the caller's until `retire`;
  // null when there is none, or when the ring has no room: try next tick.
  // At most one taken set may be waiting for its `retire` beside the newest one.
  T* acquire() noexcept {
    if (pending_.load(std::memory_order_relaxed) == nullptr || !retired_.has_room()) return nullptr;
    return pending_.exchange(nullptr, std::memory_order_acq_rel);
  }

  // Haptics thread. Wait-free. Hands `old` over to be deleted. There is room:
  // `take` saw it, and only this fills the ring.
  void retire(T* old) noexcept { retired_.push(old); }

 private:
  std::atomic<T*> pending_{nullptr};
  SpscRing<T*, 8> retired_;
};

}  // namespace palpate
