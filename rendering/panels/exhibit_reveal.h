// The reveal of a round of the exhibit: the visitor's press with the largest difference, in slow motion. The blocks
// show its motion and dents. Two arrows beside each other show the forces, in front of a band of one JND about the
// first. Then the motion goes back to the moment of the largest difference and stands still there.
// Thread guarantee: the window's thread.
#pragma once

#include <vector>

#include "engine/tick/jnd.h"
#include "rendering/panels/panel_parts.h"
#include "scenes/live/exhibit_game.h"

namespace palpate {

class ExhibitReveal {
 public:
  using Moment = ExhibitTrace::Column;

  // `slowness`: duration of the reveal / duration of the press. `now_s`, here and below: time of one steady clock, s.
  void start(const ExhibitTrace& trace, const JndLine& jnd, double slowness, double now_s);
  bool done(double now_s) const noexcept { return columns_since_start(now_s) >= end() + kBack; }
  Moment at(double now_s) const noexcept;
  // The second force, N: first_N + over_jnd JND(first_N). It is that of the mean over 50 ms that decides the round.
  double second_N(const Moment& moment) const noexcept { return moment.first_N + moment.over_jnd * jnd_N(moment); }

  // Draws both arrows, the first at the left if `first_is_left`, and the band into `area`. All moments of the press
  // have the same scale. On the way back to the largest difference, the arrows grow until they fill the area.
  void draw_arrows(const UiStyle& style, const SceneArea& area, double now_s, const Rgb& first, const Rgb& second,
                   bool first_is_left) const;

 private:
  static constexpr double kBack = 0.25 / ExhibitTrace::kColumn_s;  // duration of the way back, in columns

  double end() const noexcept { return static_cast<double>(moments_.size() - 1); }  // the last index into moments_
  double columns_since_start(double now_s) const noexcept {
    return (now_s - began_s_) / slowness_ / ExhibitTrace::kColumn_s;
  }
  // Share of the way back from the end of the press to the largest difference, 0 to 1, with a smooth start and end.
  double way_back(double now_s) const noexcept;
  double playhead(double now_s) const noexcept;  // index into moments_, with a fraction
  double jnd_N(const Moment& moment) const noexcept { return jnd_.at(moment.first_N); }

  std::vector<Moment> moments_{1};  // one for each column of the trace
  std::size_t largest_at_ = 0;
  JndLine jnd_;
  double slowness_ = 1.0, began_s_ = 0.0;
};

}  // namespace palpate
