// What the methods do with data that break numerics, and models with
// motions far from their data: every method meets every case.
//
// Four kinds of case, all made up and always the same:
//   sites       coinciding, clustered, flat and badly scaled points; as few as
//               one; more centres than sites. Evaluated at other points nearby.
//   recording   what sensors and hands do wrong: noise, drift, outliers, lost
//               and jittered samples, extreme rates. Evaluated on a clean press.
//   motion      presses unlike the training: deeper, faster, longer, abrupt.
//   material    these motions in every virtual material, features as its recording has them.
// The truth is a closed form, or the material, so the error is known. Of direct interpolation the
// system of eq. 4 is also solved in long double, where it is small enough.
//
// `safe` means: every value finite and bounded (a site case: held-out values
// within 1.2 times the range of the forces beyond it; the others: forces from 0
// to 1.2 times the largest training force), or the fit refused with a message.
// `outcome` says how near the truth that is.
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
  double condition = 0.0;       // of the system solved, see FitReport
  double residual = 0.0;        // RMS over the sites, times row_scale: in JNDs
  double smoothing = 0.0;       // chosen, see FitReport
  double worst_over_jnd = 0.0;  // largest error on what was held out
  double within_jnd = 0.0;      // share of what was held out
  bool safe = false;
};

// All but the materials, case by case, methods in the order of methods(). Some seconds.
// Deterministic. Slow side.
std::vector<HardCaseResult> run_hard_cases();

// Its parts, and the materials.
std::vector<HardCaseResult> run_hard_sites();
std::vector<HardCaseResult> run_hard_recordings(FeatureChoice choice);
std::vector<HardCaseResult> run_hard_motions();
// Half a minute.
std::vector<HardCaseResult> run_hard_materials();

}  // namespace palpate
