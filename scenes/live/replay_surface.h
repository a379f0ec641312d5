// The surface of a recording that is replayed into a session: where the models that are ready fit it best
// (models/surface/surface_search.h), found on a thread of its own once the first model is ready and again
// when all are, and given to the device.
// Thread guarantee: one thread; only the destructor waits, some tenths of a second for a search.
#pragma once

#include <cstddef>
#include <future>

#include "engine/live/device.h"
#include "engine/tick/jnd.h"
#include "models/surface/surface_search.h"

namespace palpate {

class ModelSlots;

class ReplaySurface {
 public:
  // `replay` outlives this; null: no recording, and nothing ever happens.
  ReplaySurface(ReplayControl* replay, const JndLine& jnd) : replay_(replay), jnd_(jnd) {}

  // Once a frame. Returns whether the positions are other ones from now on.
  bool update(const ModelSlots& models);
  // Whether positions are moved; as recorded when not. Returns as `update`.
  bool move(bool moved);

  bool moved() const noexcept { return moved_; }
  double found_m() const noexcept { return found_.at; }  // 0: none, or not yet
  // What is subtracted from the positions now.
  double offset_m() const noexcept { return moved_ ? found_m() : 0.0; }

 private:
  bool apply();

  ReplayControl* replay_;
  JndLine jnd_;
  bool moved_ = true;
  std::size_t searched_models_ = 0;  // of the last search
  Located found_;
  std::future<Located> search_;
};

}  // namespace palpate
