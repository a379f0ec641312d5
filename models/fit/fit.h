// From recordings to a model: the whole of `palpate fit`, as two steps, so that
// a comparison of methods prepares the data once.
//
//   prepare_training   greatest depth, relaxation times, trend, features,
//                      normalisation, reduction, one-sided contact, domain cover
//   fit_method         one of the five methods on the prepared sites
//
// The paper's own recipe (reduction by force and weighting 1/f, together) is
// run as the paper has it: low-pass features and the force itself as target,
// the trend (position alone) only away from the data. Otherwise the methods fit
// what the viscoelastic trend leaves over.
// Thread guarantee: slow side.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "engine/base/result.h"
#include "engine/base/fit_control.h"
#include "models/fit/correction_strength.h"
#include "models/fit/fit_report.h"
#include "models/training/feature_selection.h"
#include "models/training/fit_trend.h"
#include "models/model/fitted_model.h"
#include "models/training/motion_source.h"
#include "models/training/sites.h"
#include "models/training/training_set.h"
#include "models/training/weighting.h"

namespace palpate {

enum class Method { direct, voxel, random, kdtree, greedy };
inline constexpr std::array<Method, 5> kMethods{Method::direct, Method::voxel, Method::random, Method::kdtree,
                                                Method::greedy};
std::string_view method_name(Method method);
// Nothing for a name that is none of them.
std::optional<Method> method_from_name(std::string_view name);

enum class Relaxation { scene, automatic, given };
// Which features: those that the recordings support (feature_selection.h), the
// scene's (with `relaxation`), or a list.
enum class FeatureChoice { automatic, scene, given };
enum class DirectSolverChoice { cholesky, tsvd };

struct TrainingRequest {
  std::string scene;
  std::vector<FeatureSpec> features;  // the scene's: depth, velocity, lowpass_velocity
  JndLine jnd;
  Weighting weighting = Weighting::jnd;
  Reduction reduction = Reduction::coverage;
  FeatureChoice choice = FeatureChoice::scene;
  FeatureList list;  // when given
  Relaxation relaxation = Relaxation::scene;
  std::vector<double> relaxation_times_s;  // when given
  BranchDrive drive = BranchDrive::elastic_rate;
};

struct MethodRequest {
  Method method = Method::greedy;
  int centres = 100;
  int candidates = 100;  // per greedy step; 0: every site
  KernelKind kernel = KernelKind::cubic;
  DirectSolverChoice solver = DirectSolverChoice::cholesky;
  std::vector<int> grid;  // nodes per feature; empty: 25 for depth, 11 for the others (in 4-D)
  std::uint64_t seed = 1;
};

struct PreparedTraining {
  TrainingSet set;
  Sites sites;       // normalised; target: what h has to fit
  ModelData common;  // everything of a model but its method's part
  FeatureSelection selection;              // what each feature is worth; empty unless chosen here
  std::optional<StrengthChoice> strength;  // of the correction; none for the paper's recipe
  // In-contact feature vectors and forces to judge the fit by, at most 100,000.
  std::vector<std::array<double, kMaxFeatures>> judge_features;
  std::vector<double> judge_force_N;
  std::vector<int> judge_fold;
};

struct MethodFit {
  ModelData data;
  FitReport report;
};

// Errors: those of the recordings; nothing in contact; the request does not fit
// the scene; interrupted.
Result<PreparedTraining> prepare_training(MotionSource& source, const TrainingRequest& request,
                                          const FitControl& control = {});

// Errors: the method cannot be fitted to these sites (says why); interrupted.
// The same prepared training and request give the same bits. `direct`: the fit
// by Method::direct of the same prepared training, kernel and solver, when there is
// one already; voxel then fills its grid from it instead of fitting it again.
Result<MethodFit> fit_method(const PreparedTraining& prepared, const MethodRequest& request,
                             const FitControl& control = {}, const MethodFit* direct = nullptr);

}  // namespace palpate
