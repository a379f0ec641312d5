// Parallel loops, progress and cancellation of the fits. Not for the tick.
#pragma once

#include <functional>

#include "engine/base/result.h"

namespace palpate {

// The number of threads of a fit: one for each processor of the machine, or a smaller limit. The limit is for programs
// that run several fits as processes; set it before the first fit.
int thread_count();
void limit_threads(int most);

// Calls work(0) ... work(count - 1) once each on up to thread_count() threads, and returns when all calls have ended.
// The assignment of parts to threads is not deterministic, so parts must write to separate memory; results that are
// then combined in the order of the parts are deterministic. `work` must not throw.
void parallel_for(int count, const std::function<void(int part)>& work);

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
