// Progress and cancellation of a fit. Thread guarantee: slow side.
#pragma once

#include <functional>

#include "engine/base/result.h"

namespace palpate {

struct FitControl {
  // Called from time to time on the fitting thread with the finished fraction, 0 to 1. If it returns false, the fit
  // ends with the error interrupted(). May be empty.
  std::function<bool(double fraction)> progress;

  bool may_continue(double fraction = 0.0) const { return !progress || progress(fraction); }
  // The control of one step, during which the finished fraction stays `fraction`.
  FitControl at(double fraction) const {
    if (!progress) return {};
    return {[call = progress, fraction](double) { return call(fraction); }};
  }
  // The control of a step that takes the finished fraction from `begin` to `end`.
  FitControl part(double begin, double end) const {
    if (!progress) return {};
    return {[call = progress, begin, end](double fraction) { return call(begin + (end - begin) * fraction); }};
  }
};

inline Error interrupted() { return Error{"interrupted"}; }

}  // namespace palpate
