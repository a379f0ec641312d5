// The protocol of Hoever & Harders (2009) on virtual material, since the paper's own recordings are not public.
//
//   recordings  one to train and one to test, 41,499 and 45,272 samples at 1 kHz, with accelerometer
//   sites       samples at steps of 50 mN; depth, velocity and two low-passed velocities, with the paper's relaxation
//               times and with times fitted to the recording; rows scaled by 1/f
//   methods     interpolation of all sites on an even 25x11x11x11 grid; 100 centres: random, kD-tree, greedy with 20
//               and with 100 candidates a step
//   errors      of the test's samples in contact, through the tick
// Thread guarantee: slow side.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "scenes/evaluation/model_timing.h"

namespace palpate {

// Errors of the samples of a range of forces.
struct PaperBin {
  double force_N = 0.0;  // mean
  std::uint64_t count = 0;
  double mean_N = 0.0;  // absolute error
  double std_N = 0.0;
  double max_N = 0.0;
  double mean_relative = 0.0;  // over the force
  double std_relative = 0.0;
  double max_relative = 0.0;
};

struct PaperModel {
  std::string name;
  std::uint32_t colour = 0;
  double fit_seconds = 0.0;
  ModelTiming time;
  double rms_N = 0.0;
  std::vector<PaperBin> bins;
};

// Of one material and one pair of relaxation times.
struct PaperRun {
  std::string material;
  bool fitted_times = false;
  std::vector<double> times_s;
  std::uint64_t trained = 0;  // samples
  std::uint64_t tested = 0;
  std::uint64_t sites = 0;
  std::vector<PaperModel> models;  // the grid, random, kD-tree, greedy-20, greedy-100
};
enum PaperMethod : std::size_t { kGridOfAll, kRandomCentres, kTreeCentres, kGreedy20, kGreedy100, kPaperMethods };

// Seconds of a fit, a row a number of sites; figure 8.
struct FitTimes {
  std::size_t sites = 0;
  std::vector<double> seconds;  // a method
};
// Of a domain of so many dimensions; figure 2.
struct DimensionTimes {
  std::size_t dimensions = 0;
  double solve_s = 0.0;
  double grid_s = 0.0;  // 10 nodes a dimension
};

struct PaperData {
  JndLine jnd;
  std::vector<PaperRun> runs;
  std::vector<FitTimes> by_sites;
  std::vector<DimensionTimes> by_dimension;
};

// `quick`: fewer samples, sites and dimensions, and one pair of times. Errors: the 50 mN steps grew; those of the fits;
// interrupted.
Result<PaperData> measure_paper(bool quick, const FitControl& control);

// A claim of the paper, what stands there, and what was found here, a text a run.
struct Claim {
  std::string claim;
  std::string there;
  std::vector<std::string> here;
  std::vector<bool> reproduced;
  std::string why;  // it is not, or what differs
};
std::vector<Claim> paper_claims(const PaperData& data);
// "silicone", "silicone, fitted times".
std::string run_name(const PaperRun& run);

// Writes index.html, tables and figures 2 to 8 into `out`, which appears only when all is there. Returns a sentence.
struct PaperRequest {
  bool quick = false;
  std::string out;
  bool force = false;
  std::string origin;  // what made it
};
Result<std::string> make_paper(const PaperRequest& request, const FitControl& control = {});

}  // namespace palpate
