// Tests the ready models of a session on the whole recording that is replayed, as `palpate replay` does
// (scenes/evaluation/evaluate.h, with a surface offset for each model), wherever the replay is. It also estimates one
// surface offset for all models together and applies it to the replay. Both run on a separate thread: once the first
// model is ready, and after all fits have ended whenever the ready models have changed.
// Thread guarantee: one thread; only the destructor waits, some tenths of a second.
#pragma once

#include <atomic>
#include <future>
#include <memory>
#include <vector>

#include "engine/live/device.h"
#include "engine/tick/jnd.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/evaluation/surface_search.h"

namespace palpate {

class SessionModels;

class ReplayTest {
 public:
  // `replay` outlives this; null: there is no recording to test on.
  ReplayTest(ReplayControl* replay, const JndLine& jnd) : replay_(replay), jnd_(jnd) {}
  ReplayTest(const ReplayTest&) = delete;
  ReplayTest& operator=(const ReplayTest&) = delete;
  ~ReplayTest() { cancelled_.store(true, std::memory_order_relaxed); }

  // Call it once a frame. Returns whether the offset of the replay changed.
  bool update(const SessionModels& models);
  // Whether to apply the estimated offset. Returns as `update`.
  bool move(bool moved);

  bool moved() const noexcept { return moved_; }
  double found_m() const noexcept { return found_.surface.at; }  // estimated offset; 0: none yet, or not significant
  // The offset that is subtracted from the positions now.
  double offset_m() const noexcept { return moved_ ? found_m() : 0.0; }
  // The errors of a model over the whole recording; null: not tested yet. `errors` are those to show, with the surface
  // moved or as recorded (`moved`). `as_recorded` always decide the ranking, as in a report.
  const UnitErrors* errors(const ForceModel* model) const noexcept;
  const UnitErrors* as_recorded(const ForceModel* model) const noexcept;
  // Number of finished tests.
  int rounds() const noexcept { return rounds_; }

 private:
  struct Tested {
    std::shared_ptr<const ForceModel> model;
    UnitErrors as_recorded, surface_moved;
  };
  struct Outcome {
    OffsetEstimate surface;
    std::vector<Tested> models;
  };
  Outcome run(const std::vector<std::shared_ptr<const ForceModel>>& models) const;
  const Tested* find(const ForceModel* model) const noexcept;  // null: not tested yet
  bool apply();

  ReplayControl* replay_;
  JndLine jnd_;
  bool moved_ = true;
  int rounds_ = 0;
  std::vector<std::shared_ptr<const ForceModel>> requested_;  // models of the last test
  Outcome found_;
  std::atomic<bool> cancelled_{false};
  std::future<Outcome> running_;
};

}  // namespace palpate
