// The worst seconds among test recordings.
//
// Thread guarantee: slow side; one thread per object.
#pragma once

#include "scenes/report/measure/evaluator.h"

namespace palpate {

// Keeps the worst kTraceSeconds among the recordings it is shown: those with the
// largest mean squared error/JND over the samples in contact and the models that count.
class TraceFinder {
 public:
  static constexpr double kTraceSeconds = 5.0;

  // `counting`: for each main model, whether its error counts.
  TraceFinder(const JndLine& jnd, std::vector<bool> counting) : jnd_(jnd), counting_(std::move(counting)) {}
  // `models`: the main ones.
  Status search(const Recording& recording, const std::vector<ModelPointer>& models);
  const WorstTrace& worst() const { return worst_; }

 private:
  JndLine jnd_;
  std::vector<bool> counting_;
  WorstTrace worst_;
  double worst_score_ = -1.0;
};

}  // namespace palpate
