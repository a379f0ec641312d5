// The table of methods. All code that offers, fits, draws or times methods iterates over `methods()`. A new method is
// one source file that defines its row and its fit, and one line in PALPATE_METHODS.
//
// A method computes the correction of a model (models/model/correction.h) from the sites, which are the same for all
// methods; fit.h does the rest.
// Thread guarantee: rows are constants; the functions are slow side.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "models/model/correction.h"
#include "models/model/rbf/kernels.h"
#include "models/solve/solve_weights.h"
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

// The parameters of a method; each uses those that its row names in `takes`.
struct MethodRequest {
  const Method* method = &kGreedyMethod;
  int centres = 100;
  int candidates = 100;  // per greedy step; 0: every site
  KernelKind kernel = KernelKind::cubic;
  std::vector<int> grid{};  // nodes per feature; empty: 25 for depth, 11 for the others, fewer beyond four features
  std::uint64_t seed = 1;
};

// The centres of a method for every number of centres up to a maximum, for methods whose selections are nested: greedy
// and random add one centre a step, the kD-tree replaces one by two.
struct CentreSequence {
  Eigen::MatrixXd pool;  // d x m, the centres of all selections in order of appearance
  // The index of each column of `pool` within a selection. A later column replaces an earlier one with the same index.
  std::vector<Eigen::Index> places;
  Eigen::Index columns_a_step = 1;  // by which each centre after the first enlarges the pool
  std::string shortage;             // why most() is less than requested; else empty

  // The maximum number of centres.
  Eigen::Index most() const { return pool.cols() > 0 ? 1 + (pool.cols() - 1) / columns_a_step : 0; }
  // The columns of `pool` of the selection of `count` centres (0 to most()), in the order of their indices.
  std::vector<Eigen::Index> columns_of(Eigen::Index count) const {
    std::vector<Eigen::Index> columns(static_cast<std::size_t>(count));
    const Eigen::Index used = count > 0 ? 1 + columns_a_step * (count - 1) : 0;
    for (Eigen::Index j = 0; j < used; ++j) {
      columns[static_cast<std::size_t>(places[static_cast<std::size_t>(j)])] = j;
    }
    return columns;
  }
  Eigen::MatrixXd centres_of(Eigen::Index count) const { return pool(Eigen::all, columns_of(count)); }

  // A sequence in which each centre is added after those before it and stays.
  static CentreSequence growing(Eigen::MatrixXd centres) {
    CentreSequence sequence{std::move(centres), {}, 1, ""};
    sequence.places.resize(static_cast<std::size_t>(sequence.pool.cols()));
    std::iota(sequence.places.begin(), sequence.places.end(), Eigen::Index{0});
    return sequence;
  }
};

// The result of a method.
struct FittedCorrection {
  CorrectionPtr correction;
  FitReport report;
  std::string size;  // follows the method in the name of the model: "100"; or empty
};

FittedCorrection rbf_correction(FittedRbf fitted, std::string size);

// The input of a method. References must be valid during the call.
struct MethodTask {
  const Sites& sites;            // normalised
  const Eigen::VectorXd& jnd_N;  // threshold at each site, > 0
  const MethodRequest& request;
  const FittedCorrection* base = nullptr;  // fit of the row's base; null: none
};

enum MethodOption : unsigned {
  kTakesCentres = 1U << 0,
  kTakesCandidates = 1U << 1,
  kTakesGrid = 1U << 2,
  kTakesKernel = 1U << 3,
  kTakesSeed = 1U << 4,
};

// The colour of items without a hue of their own: black on white and white on black.
inline constexpr std::uint32_t kNeutralColour = 0x000000;

struct Method {
  const char* name = "";                  // in commands, files and scenes
  const char* label = "";                 // in figures and tables
  std::uint32_t colour = kNeutralColour;  // 0xRRGGBB, the same in all figures
  unsigned takes = 0;                     // MethodOption flags
  // The method whose fit this one starts from, or null.
  const Method* base = nullptr;
  // Approximate time of the fit without the base, on one core of 2023 with 7,000 sites: for progress lines, and to fit
  // the fastest method first.
  double (*expected_seconds)(const MethodRequest& request) = nullptr;
  // One of two functions, to be called by fit_correction. Errors: the sites cannot be fitted (says why); interrupted.
  // Deterministic.
  Result<FittedCorrection> (*fit)(const MethodTask& task, const FitControl& control) = nullptr;
  // Selects the centres for every number up to request.centres (nested_fit.h), whose weights are then solved for. Fewer
  // are returned, with the reason, if no further one lowers the error.
  Result<CentreSequence> (*choose)(const MethodTask& task, const FitControl& control) = nullptr;

  bool can_take(MethodOption option) const { return (takes & option) != 0; }
};

const std::vector<const Method*>& methods();
// Null for an unknown name.
const Method* find_method(std::string_view name);

// "trend, direct, voxel ...".
std::string method_names();
// "random, kdtree, greedy": the methods that use this option.
std::string methods_that_take(MethodOption option);

// Fits request.method, and before it its base if the task has none. Errors: those of validate_sites and of the method.
Result<FittedCorrection> fit_correction(const MethodTask& task, const FitControl& control = {});
// The sum for the method and its base.
double expected_seconds(const MethodRequest& request);

}  // namespace palpate
