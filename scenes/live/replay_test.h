// A recording that is replayed into a session, as a test of the models that are ready: the errors over all of
// it, as `palpate replay` has them (scenes/evaluation/evaluate.h), wherever the playhead is; and where its
// surface is for the models together, which is given to the device. Found on a thread of its own, once the
// first model is ready and again when all are.
// Thread guarantee: one thread; only the destructor waits, some tenths of a second.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <vector>

#include "engine/live/device.h"
#include "engine/tick/jnd.h"
#include "models/surface/surface_search.h"
#include "scenes/evaluation/model_errors.h"

namespace palpate {

class SessionModels;

class ReplayTest {
 public:
  // `replay` outlives this; null: no recording, and nothing ever happens.
  ReplayTest(ReplayControl* replay, const JndLine& jnd) : replay_(replay), jnd_(jnd) {}
  ReplayTest(const ReplayTest&) = delete;
  ReplayTest& operator=(const ReplayTest&) = delete;
  ~ReplayTest() { cancelled_.store(true, std::memory_order_relaxed); }

  // Once a frame. Returns whether the positions are other ones from now on.
  bool update(const SessionModels& models);
  // Whether positions are moved; as recorded when not. Returns as `update`.
  bool move(bool moved);

  bool moved() const noexcept { return moved_; }
  double found_m() const noexcept { return found_.surface.at; }  // 0: none, or not yet
  // What is subtracted from the positions now.
  double offset_m() const noexcept { return moved_ ? found_m() : 0.0; }
  // Of a model over the whole recording; null: not known yet.
  const Evidence* errors(const ForceModel* model) const noexcept;
  // How often there were new ones.
  int rounds() const noexcept { return rounds_; }

 private:
  struct Tested {
    std::shared_ptr<const ForceModel> model;
    Evidence as_recorded, surface_moved;
  };
  struct Outcome {
    OffsetEstimate surface;
    std::vector<Tested> models;
  };
  Outcome run(const std::vector<std::shared_ptr<const ForceModel>>& models) const;
  bool apply();

  ReplayControl* replay_;
  JndLine jnd_;
  bool moved_ = true;
  int rounds_ = 0;
  std::vector<std::shared_ptr<const ForceModel>> asked_;  // of the last run
  Outcome found_;
  std::atomic<bool> cancelled_{false};
  std::future<Outcome> running_;
};

}  // namespace palpate
