// A fitted model as one self-contained C99 file: no allocation, no library but sqrt,
// exp and log, for a microcontroller or an engine that takes no dependency.
//
//   double palpate_force(double time_s, double position_m);   N, 0 out of contact
//   double palpate_force_after(double step_s, double position_m);
//   void palpate_reset(void);
//   int palpate_out_of_domain(void);
//
// (float instead of double with `single_precision`.) The file has the motion estimator
// for positions alone, the features, the trend, the correction and the trust in it: the
// calculation of palpate_stream_force for the same encoder step and position noise, to
// rounding. The same model gives the same bytes.
// Thread guarantee: pure function, slow side (allocates).
#pragma once

#include <cstddef>
#include <string>

#include "engine/base/result.h"
#include "models/export/c_text.h"
#include "models/model/fitted_model.h"

namespace palpate {

struct ExportRequest {
  bool single_precision = false;
  // Defaults of two macros of the file; 0 and 0: exact positions.
  PositionSensor sensor;
};

struct ExportedC {
  std::string text;
  std::size_t table_bytes = 0;  // of constants in the compiled program
  std::size_t state_bytes = 0;  // of variables
};

// `data` must pass validate_model. Errors: a kind of correction that has no C text yet.
Result<ExportedC> export_c(const ModelData& data, const ExportRequest& request);

}  // namespace palpate
