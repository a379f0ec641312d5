// Writes a fitted model as one self-contained C99 file without allocation or libraries other than sqrt, exp and log:
// for microcontrollers and for programs without dependencies.
//
//   double palpate_force(double time_s, double position_m);   N, 0 out of contact
//   double palpate_force_after(double step_s, double position_m);
//   void palpate_reset(void);
//   int palpate_out_of_domain(void);
//
// (float instead of double with `single_precision`.) The file contains the motion estimator for positions alone, the
// features, the trend, the correction and the trust. Its forces equal those of palpate_stream_force with the same
// encoder step and position noise, to rounding. The same model gives the same bytes.
// Thread guarantee: pure function, slow side (allocates).
#pragma once

#include <cstddef>
#include <string>

#include "models/export/c_text.h"
#include "models/model/fitted_model.h"

namespace palpate {

struct ExportRequest {
  bool single_precision = false;
  // Defaults of two macros of the file; both 0: exact positions.
  SensorSpec sensor;
};

struct ExportedC {
  std::string text;
  std::size_t table_bytes = 0;  // size of the constants in the compiled program
  std::size_t state_bytes = 0;  // size of the variables
};

ExportedC export_c(const ModelData& data, const ExportRequest& request);

}  // namespace palpate
