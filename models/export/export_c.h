// Writes a fitted model as one self-contained C99 file without allocation or libraries other than sqrt, exp and log:
// for microcontrollers and for programs without dependencies. head.inc describes its functions. It contains the motion
// estimator for positions alone, the features, the trend, the correction and the trust, with float instead of double if
// `single_precision`. Its forces equal those of palpate_stream_force with the same encoder step and position noise, to
// rounding. The same model gives the same bytes. Thread guarantee: pure function, slow side (allocates).
#pragma once

#include <string>

#include "models/model/fitted_model.h"

namespace palpate {

// `sensor`: the defaults of the macros of the file for step and noise; both 0: exact positions.
std::string export_c(const ModelData& data, const SensorSpec& sensor, bool single_precision = false);

}  // namespace palpate
