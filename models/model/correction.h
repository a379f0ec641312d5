// The correction h(u) of the trend, a function of the normalised features. Its kinds (radial basis functions, a grid)
// are classes with one interface; only the model file and the exported C distinguish them.
//
// Thread guarantee: a Correction is immutable and may be shared by any threads; its functions are as in ForceModel.
#pragma once

#include <memory>

namespace palpate {

class Correction {
 public:
  virtual ~Correction() = default;

  // h(u) in newtons. `u`: one normalised value per feature. Haptics thread, wait-free, no allocation.
  virtual double evaluate(const double* u) const noexcept = 0;
  // The number of centres, or of nodes of a grid.
  virtual int size() const noexcept = 0;
};

// Null: the model is its trend alone.
using CorrectionPtr = std::shared_ptr<const Correction>;

}  // namespace palpate
