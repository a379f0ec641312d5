// The protocol of Hoever & Harders (2009) on two virtual materials, because the paper's recordings are not public.
//
//   recordings  one for training and one for the test, 41,499 and 45,272 samples at 1 kHz, with accelerometer
//   sites       samples at steps of 50 mN; depth, velocity and two low-pass velocities, with the paper's relaxation
//               times and with times fitted to the recording; rows scaled by 1/f
//   methods     interpolation of all sites on a 25x11x11x11 grid; 100 centres: random, kD-tree, greedy with 20
//               and with 100 candidates per step
//   open        kernel, normalisation and truncation: selected by cross-validation on the training recording
//   errors      of the samples in contact of the test, through the tick
//   study       twelve simulated subjects, whose JND is that of the paper at 2.5 N
// Thread guarantee: slow side.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "engine/tick/jnd.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/report/publish.h"
#include "scenes/study/study_analysis.h"

namespace palpate {

struct PaperModel {
  std::string name;
  std::uint32_t colour = 0;  // 0xRRGGBB
  double fit_seconds = 0.0;  // processor time; of random with the selection of the open choices
  ModelTiming time;
  ErrorSummary errors;  // without the bins of few samples
};

// The results for one material and one pair of relaxation times.
struct PaperRun {
  std::string material;
  bool fitted_times = false;      // false: the paper's relaxation times
  std::vector<double> times_s{};  // relaxation times
  std::uint64_t trained = 0;      // number of training samples
  std::uint64_t tested = 0;       // number of test samples
  std::uint64_t sites = 0;
  std::string choices{};                // kernel, normalisation and truncation of the centres, in words
  std::vector<PaperModel> models{};     // in the order of PaperMethod
  std::vector<PaperModel> repeated{};   // greedy-100 with other seeds
  std::vector<PaperModel> settings{};   // kD-tree with every kernel and normalisation and several truncations
  std::vector<PaperModel> exchanged{};  // as `models`, trained on the test recording and tested on the other
};
enum PaperMethod : std::size_t { kGridOfAll, kRandomCentres, kTreeCentres, kGreedy20, kGreedy100, kPaperMethods };

// Processor time of the fits to one set of sites.
struct FitTimes {
  std::size_t of = 0;                         // number of sites, or of dimensions
  std::array<double, kPaperMethods> fit_s{};  // 0: not measured; of kGridOfAll the interpolation and its grid
  double solve_s = 0.0;                       // of the weights of the interpolation
  double grid_s() const { return fit_s[kGridOfAll] - solve_s; }
};

struct PaperData {
  JndLine jnd;
  bool quick = false;
  std::vector<PaperRun> runs;
  std::vector<FitTimes> by_sites;                     // figure 8
  std::vector<FitTimes> by_dimension;                 // figure 2: a grid of 10 nodes per dimension, and greedy-20
  std::vector<std::pair<double, double>> by_centres;  // of one evaluation: number of centres, processor time in s
  // The largest ratio of the slowest to the fastest round of one measurement. Times are those of the fastest.
  double slowest_round = 1.0;
  std::vector<JndPoint> points;  // of the study, and of Pang, Tan & Durlach (1991)
  JndLines lines;                // through the points
};

// `quick`: fewer samples, sites and dimensions, and only the paper's relaxation times. Errors: the reduction needed
// steps above 50 mN; those of the fits; interrupted.
Result<PaperData> measure_paper(bool quick, const FitControl& control);

enum class ClaimVerdict {
  none,  // not measured in that run
  reproduced,
  different,
  undecided,  // by a quick run
  // Not comparable: a figure that depends on what the paper had.
  other_machine,
  other_recording,
  other_subjects,
};

// A claim of the paper, compared with the results.
struct Claim {
  struct Result {
    std::string text;
    ClaimVerdict verdict = ClaimVerdict::none;
  };
  std::string claim;
  std::string there;           // the result in the paper
  std::string tolerance{};     // what counts as reproduced, and why
  std::string why{};           // a reason for a difference
  std::vector<Result> here{};  // the result of each run
};
std::vector<Claim> paper_claims(const PaperData& data);
// The name of a run: "silicone", "silicone, fitted times".
std::string run_name(const PaperRun& run);

// Writes index.html, report.json, tables and figures 2 to 8 into `out`, which appears only when it is complete.
// Returns how many claims were reproduced, as a sentence. Errors: those of ReportFolder::create, measure_paper and
// draw_figures; interrupted.
struct PaperRequest : PageRequest {
  bool quick = false;
};
Result<std::string> make_paper(const PaperRequest& request, const FitControl& control = {});

}  // namespace palpate
