// The methods, in one table: everything that offers, fits, draws or times methods
// iterates over `methods()`. A new method is one source file that defines its row
// and its fit, and one line in PALPATE_METHODS.
//
// A method gives the correction of a model (models/model/correction.h), from the
// sites that all methods share; fit.h does the rest.
// Thread guarantee: rows are constants; the functions are slow side.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "models/model/correction.h"
#include "models/model/rbf/kernels.h"
#include "models/solve/centre_sequence.h"
#include "models/solve/fit_report.h"
#include "models/training/sites.h"

// The table, in the order of reports and lists.
#define PALPATE_METHODS(ROW) \
  ROW(kTrendMethod)          \
  ROW(kDirectMethod)         \
  ROW(kVoxelMethod)          \
  ROW(kRandomMethod)         \
  ROW(kKdTreeMethod)         \
  ROW(kGreedyMethod)

namespace palpate {

struct Method;
#define PALPATE_DECLARE_METHOD(row) extern const Method row;
PALPATE_METHODS(PALPATE_DECLARE_METHOD)
#undef PALPATE_DECLARE_METHOD

// What is asked of a method; it looks at what its row says it takes.
struct MethodRequest {
  const Method* method = &kGreedyMethod;
  int centres = 100;
  int candidates = 100;  // per greedy step; 0: every site
  KernelKind kernel = KernelKind::cubic;
  std::vector<int> grid{};  // nodes per feature; empty: 25 for depth, 11 for the others (in 4-D)
  std::uint64_t seed = 1;
};

// What a method gives.
struct FittedCorrection {
  CorrectionPtr correction;
  FitReport report;
  std::string size;  // behind the method's name in the model's: "100"; empty: nothing
};

// What a method is given. References last as long as the call.
struct MethodTask {
  const Sites& sites;                        // normalised
  const std::vector<FeatureSpec>& features;  // of the rows of sites.points
  const Eigen::VectorXd& jnd_N;              // threshold at each site, > 0
  const MethodRequest& request;
  const FittedCorrection* base = nullptr;  // the fit of the row's base, if it has one
};

enum MethodOption : unsigned {
  kTakesCentres = 1U << 0,
  kTakesCandidates = 1U << 1,
  kTakesGrid = 1U << 2,
  kTakesKernel = 1U << 3,
  kTakesSeed = 1U << 4,
};

// Black on white and white on black: the colour of whatever has no hue of its own.
inline constexpr std::uint32_t kNeutralColour = 0x000000;

struct Method {
  const char* name = "";                  // in commands, files and scenes
  const char* label = "";                 // in figures and tables
  std::uint32_t colour = kNeutralColour;  // 0xRRGGBB, the same everywhere
  unsigned takes = 0;                     // MethodOption flags
  // The method whose fit this one starts from; null for most.
  const Method* base = nullptr;
  // About, on one core of 2023 with 7,000 sites, beyond what the base takes: for
  // progress lines, and so that the quickest is fitted first.
  double (*expected_seconds)(const MethodRequest& request) = nullptr;
  // Errors: the sites cannot be fitted (says why); interrupted. The same task gives
  // the same bits. Call it through fit_correction.
  Result<FittedCorrection> (*fit)(const MethodTask& task, const FitControl& control) = nullptr;
  // The centres alone, of every number up to request.centres (nested_fit.h); null: a fit
  // does not go on from those with fewer.
  Result<CentreSequence> (*choose)(const MethodTask& task, const FitControl& control) = nullptr;

  bool can_take(MethodOption option) const { return (takes & option) != 0; }
};

const std::vector<const Method*>& methods();
// Null for a name that is none of them.
const Method* find_method(std::string_view name);
// One more row, for a program with a method of its own: it must outlive every use.
// Before other threads fit or draw; the name must be new. And its end.
void add_method(const Method& method);
void remove_method(const Method& method);

// "trend, direct, voxel ...".
std::string method_names();
// "random, kdtree, greedy": the methods that take this option.
std::string methods_that_take(MethodOption option);

// Fits request.method to the task, its base first when the task brings none.
Result<FittedCorrection> fit_correction(const MethodTask& task, const FitControl& control = {});
// Of the method and its base together.
double expected_seconds(const MethodRequest& request);

}  // namespace palpate
