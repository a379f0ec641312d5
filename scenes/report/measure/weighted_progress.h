// One progress for a job of many unequal parts.
//
// Thread guarantee: one thread.
#pragma once

#include <utility>

#include "engine/base/fit_control.h"

namespace palpate {

// `control` of each part goes from 0 to 1; the whole moves on by the part's share.
class WeightedProgress {
 public:
  WeightedProgress(FitControl whole, double total_weight) : whole_(std::move(whole)), total_(total_weight) {}

  // The control of the next part, valid until the next call of `next`.
  FitControl next(double weight) {
    done_ += weight_;
    weight_ = weight;
    const double from = done_ / total_;
    const double share = weight / total_;
    const FitControl& whole = whole_;
    return FitControl{[&whole, from, share](double fraction) { return whole.may_continue(from + share * fraction); }};
  }

 private:
  FitControl whole_;
  double total_;
  double done_ = 0.0;
  double weight_ = 0.0;
};

}  // namespace palpate
