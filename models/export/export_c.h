// Writes a fitted model as one self-contained C99 file without allocation or libraries other than sqrt, exp and log:
// for microcontrollers and for programs without dependencies.
//
//   double palpate_force_after(double step_s, double position_m);   N, 0 out of contact
//   double palpate_force(double time_s, double position_m);
//   void palpate_reset(void);
//   int palpate_out_of_domain(void);
//
// (float instead of double with `single_precision`, and then without palpate_force: a time in single precision has
// steps of 2 ms after 4.6 hours.) The file contains the motion estimator for positions alone, the features, the trend,
// the correction and the trust. Its forces equal those of palpate_stream_force with the same encoder step and position
// noise, to rounding. The same model gives the same bytes. Thread guarantee: pure function, slow side (allocates).
#pragma once

#include <string>

#include "models/model/fitted_model.h"

namespace palpate {

// `sensor`: the defaults of the macros of the file for step and noise; both 0: exact positions.
std::string export_c(const ModelData& data, const SensorSpec& sensor, bool single_precision = false);

}  // namespace palpate
