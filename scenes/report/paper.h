// The protocol of Hoever & Harders (2009) on two virtual materials, because the paper's recordings are not public.
//
//   recordings  one for training and one for the test, 41,499 and 45,272 samples at 1 kHz, with accelerometer
//   sites       samples at steps of 50 mN; depth, velocity and two low-pass velocities, with the paper's relaxation
//               times and with times fitted to the recording; rows scaled by 1/f
//   methods     interpolation of all sites on an even 25x11x11x11 grid; 100 centres: random, kD-tree, greedy with 20
//               and with 100 candidates per step
//   errors      of the samples in contact of the test, through the tick
// Thread guarantee: slow side.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "scenes/evaluation/error_figures.h"
#include "scenes/evaluation/model_timing.h"

namespace palpate {

struct PaperModel {
  std::string name;
  std::uint32_t colour = 0;  // 0xRRGGBB
  double fit_seconds = 0.0;
  ModelTiming time;
  ErrorSummary errors;  // without the bins of few samples
};

// The results for one material and one pair of relaxation times.
struct PaperRun {
  std::string material;
  bool fitted_times = false;    // false: the paper's relaxation times
  std::vector<double> times_s;  // relaxation times
  std::uint64_t trained = 0;    // number of training samples
  std::uint64_t tested = 0;     // number of test samples
  std::uint64_t sites = 0;
  std::vector<PaperModel> models;  // in the order of PaperMethod
};
enum PaperMethod : std::size_t { kGridOfAll, kRandomCentres, kTreeCentres, kGreedy20, kGreedy100, kPaperMethods };

// Time of a fit by the number of sites; figure 8.
struct FitTimes {
  std::size_t sites = 0;
  std::vector<double> seconds;  // in the order of PaperMethod
};
// Time of the interpolant by the dimension of the domain; figure 2.
struct DimensionTimes {
  std::size_t dimensions = 0;
  double solve_s = 0.0;  // fit of the weights of all sites
  double grid_s = 0.0;   // evaluation on 10 nodes per dimension
};

struct PaperData {
  JndLine jnd;
  std::vector<PaperRun> runs;
  std::vector<FitTimes> by_sites;
  std::vector<DimensionTimes> by_dimension;
};

// `quick`: fewer samples, sites and dimensions, and only the paper's relaxation times. Errors: the reduction needed
// steps above 50 mN; those of the fits; interrupted.
Result<PaperData> measure_paper(bool quick, const FitControl& control);

// A claim of the paper, compared with the results.
struct Claim {
  struct Result {
    std::string text;  // empty: not measured in that run
    bool reproduced = false;
  };
  std::string claim;
  std::string there;           // the result in the paper
  std::string why{};           // a reason for a difference
  std::vector<Result> here{};  // the result of each run
};
std::vector<Claim> paper_claims(const PaperData& data);
// The name of a run: "silicone", "silicone, fitted times".
std::string run_name(const PaperRun& run);

// Writes index.html, report.json, tables and figures 2 to 8 into `out`, which appears only when it is complete.
// Returns how many claims were reproduced, as a sentence. Errors: those of ReportFolder::create, measure_paper and
// draw_figures; interrupted.
struct PaperRequest {
  bool quick = false;
  std::string out;
  bool force = false;  // replaces an existing folder
  std::string origin;  // command line and version, for the page
};
Result<std::string> make_paper(const PaperRequest& request, const FitControl& control = {});

}  // namespace palpate
