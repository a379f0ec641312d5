#include "scenes/live/replay_surface.h"

#include <chrono>
#include <system_error>
#include <utility>

#include "scenes/live/model_slots.h"
#include "scenes/worker/model_worker.h"

namespace palpate {

bool ReplaySurface::update(const ModelSlots& models) {
  if (replay_ == nullptr) return false;
  if (search_.valid()) {
    if (search_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    found_ = search_.get();
    return apply();
  }
  auto ready = models.ready_models();
  const bool worth_it = searched_models_ == 0 || models.all_settled();
  if (ready.size() <= searched_models_ || !worth_it) return false;
  searched_models_ = ready.size();
  try {
    search_ = std::async(std::launch::async, [this, ready = std::move(ready)] {
      lower_thread_priority();
      return locate_surface(thinned_rows(replay_->recording(), kSearchRows), ready, jnd_);
    });
  } catch (const std::system_error&) {
    // No thread to be had: positions stay as recorded.
  }
  return false;
}

bool ReplaySurface::move(bool moved) {
  moved_ = moved;
  return replay_ != nullptr && apply();
}

bool ReplaySurface::apply() {
  if (replay_->surface_offset_m() == offset_m()) return false;
  replay_->move_surface(offset_m());
  return true;
}

}  // namespace palpate
