// The table of methods. All code that offers, fits, draws or times methods iterates over `methods()`. A new method is
// one source file that defines its row and its fit, and its name here and in the table of methods.cpp. It computes the
// correction of a model (models/model/correction.h) from the sites; models/fit does the rest.
// Thread guarantee: rows are constants; the functions are slow side.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "models/correction/sites.h"
#include "models/model/correction.h"

namespace palpate {

struct Method;
extern const Method kTrendMethod, kDirectMethod, kVoxelMethod, kRandomMethod, kKdTreeMethod, kGreedyMethod;

// The input of a method; each uses the parameters that its row names in `takes`. References must be valid during the
// call.
struct MethodTask {
  const Sites& sites;            // normalised
  const Eigen::VectorXd& jnd_N;  // threshold at each site, > 0
  int centres = 100;
  int candidates = 100;     // per greedy step; 0: every site
  std::vector<int> grid{};  // nodes per feature; empty: 25 for depth (200 if alone), 11 for others, fewer beyond four
  std::uint64_t seed = 1;
  CorrectionPtr base{};  // fit of the row's base; null: none
};

enum MethodOption : unsigned {
  kTakesCentres = 1U << 0,
  kTakesCandidates = 1U << 1,
  kTakesGrid = 1U << 2,
  kTakesKernel = 1U << 3,
  kTakesSeed = 1U << 4,
};

// The colour of items without a hue of their own: drawn black on white and white on black.
inline constexpr std::uint32_t kNeutralColour = 0x000000;

struct Method {
  const char* name = "";                  // in commands, files and scenes
  const char* label = "";                 // in figures and tables
  std::uint32_t colour = kNeutralColour;  // 0xRRGGBB, the same in all figures
  unsigned takes = 0;                     // MethodOption flags
  // The method whose fit this one starts from, or null.
  const Method* base = nullptr;
  // Approximate time of a fit with default options without the base, on one core of 2023 with 7,000 sites: for progress
  // lines, and to fit the fastest method first.
  double expected_seconds = 0.0;
  // To be called by fit_correction. Errors: the sites cannot be fitted (says why); interrupted. Deterministic.
  Result<FittedCorrection> (*fit)(const MethodTask& task, const FitControl& control) = nullptr;

  bool can_take(MethodOption option) const { return (takes & option) != 0; }
};

// In the order of reports and lists.
const std::vector<const Method*>& methods();
// The sum for the method and its base.
double expected_seconds(const Method& method);
// Fits the method, and before it its base if the task has none. Errors: those of validate_sites and of the method.
Result<FittedCorrection> fit_correction(const Method& method, const MethodTask& task, const FitControl& control = {});
// For methods that select centres (d x n): their weights (models/correction/algebra.h). `shortage`: why there are
// fewer than planned. Errors: the weights could not be computed.
Result<FittedCorrection> fit_centres(const MethodTask& task, const Eigen::MatrixXd& centres,
                                     const std::string& shortage);

}  // namespace palpate
