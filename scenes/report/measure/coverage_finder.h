// Where test recordings went in the feature space, and errors against force.
//
// Thread guarantee: slow side; one thread per object.
#pragma once

#include "scenes/report/data/binned_errors.h"
#include "scenes/report/measure/evaluator.h"

namespace palpate {

// Where the test recordings went in the feature space of the reference, and what the
// main models' errors were near the training data and away from them.
class CoverageFinder {
 public:
  // `models`: the names of the main models; `reference`: one of them, for inside and outside.
  CoverageFinder(const JndLine& jnd, std::vector<std::string> models, std::size_t reference, double largest_force_N);
  void add_sites(const TrainingSet& set);
  // `models`: as the names.
  Status search(const Recording& recording, const std::vector<ModelPointer>& models);
  Coverage result() const;
  std::vector<ErrorBin> bins(std::size_t model) const { return bins_[model].bins(); }

 private:
  std::vector<std::string> names_;
  std::size_t reference_;
  std::vector<ErrorStatistics> inside_;
  std::vector<ErrorStatistics> outside_;
  std::vector<BinnedErrors> bins_;
  Coverage coverage_;
};

// At most `most` of `points`, evenly spread over their order.
std::vector<CoveragePoint> thinned(const std::vector<CoveragePoint>& points, std::size_t most);

}  // namespace palpate
