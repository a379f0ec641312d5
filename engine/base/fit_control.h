// How a caller follows a fit and stops it.
#pragma once

#include <functional>

#include "engine/base/result.h"

namespace palpate {

struct FitControl {
  // Called now and then on the fitting thread with the fraction done, 0 to 1;
  // returns false to cancel the fit, which then ends with interrupted(). May
  // be empty.
  std::function<bool(double fraction)> progress;

  bool may_continue(double fraction) const { return !progress || progress(fraction); }
};

inline Error interrupted() { return Error{"interrupted"}; }

}  // namespace palpate
