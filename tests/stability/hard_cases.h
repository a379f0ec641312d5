// Numerically hard data and motions far from the data. Every method is tested
// on every case.
//
// Four kinds of case, all synthetic and deterministic:
//   sites       coinciding, clustered, flat and badly scaled points; as few as
//               one; more centres than sites. Evaluated at other points nearby.
//   recording   what sensors and hands do wrong: noise, drift, outliers, lost
//               and jittered samples, extreme rates. Evaluated on a clean press.
//   motion      presses unlike the training: deeper, faster, longer, abrupt.
//   material    these motions in every virtual material, with automatically selected features.
// The true force is a closed form or that of the material. For direct interpolation the
// system of eq. 4 is also solved in long double, if it is small enough.
//
// `safe` means: every value is finite and bounded (site cases: held-out values
// at most 1.2 times the range of the forces outside that range; others: forces from
// 0 to 1.2 times the largest training force), or the fit is refused with a message.
// `outcome` describes the error.
// Source: Hoever & Harders (2009), eqs. 2-8, for the system.
#pragma once

#include <string>
#include <vector>

#include "models/fit/fit.h"

namespace palpate {

struct HardCaseResult {
  std::string name;             // of the case
  std::string method;           // its name
  std::string outcome;          // in words
  double condition = 0.0;       // of the linear system, see FitReport
  double residual = 0.0;        // RMS over the sites, times row_scale: in JNDs
  double smoothing = 0.0;       // chosen, see FitReport
  double worst_over_jnd = 0.0;  // largest error on the held-out data
  double within_jnd = 0.0;      // share of the held-out data
  bool safe = false;
};

// With methods in the order of methods(). Deterministic.
std::vector<HardCaseResult> run_hard_sites();
std::vector<HardCaseResult> run_hard_recordings(FeatureChoice choice);
std::vector<HardCaseResult> run_hard_motions();
// The materials. Takes half a minute.
std::vector<HardCaseResult> run_hard_materials();

}  // namespace palpate
