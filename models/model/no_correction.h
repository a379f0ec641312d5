// The correction of a model that is its trend alone.
// Thread guarantee: immutable.
#pragma once

#include "models/model/correction.h"

namespace palpate {

class NoCorrection final : public Correction {
 public:
  double evaluate(const double*) const noexcept override { return 0.0; }
  int size() const noexcept override { return 0; }
  bool is_none() const noexcept override { return true; }
  Status validate(int) const override { return {}; }
  FileFields file_fields() const override;
};

}  // namespace palpate
