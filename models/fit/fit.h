// The fit of a model to recordings (`palpate fit`), in two steps, so that a comparison of methods prepares the data
// once.
//
//   prepare_training   surfaces, greatest depth, relaxation times, trend, features, normalisation, reduction,
//                      one-sided contact, domain cover, whether the correction is used
//   fit_method         one of the methods of models/fit/methods.h on the prepared sites
//
// The methods fit the residual of the trend. In the paper's recipe (recipe_2009_request) they fit the force itself,
// without trend, trust and surface search.
// Thread guarantee: slow side.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/fit/correction_choice.h"
#include "models/fit/methods.h"
#include "models/model/fitted_model.h"
#include "models/training/memory_law.h"
#include "models/training/sites.h"
#include "models/training/training_set.h"

namespace palpate {

enum class Relaxation { scene, automatic, given };
// In model files, in the order of the values.
inline constexpr std::array<const char*, 3> kRelaxationNames{"scene", "auto", "given"};
// The surface of each recording: estimated, or 0 as recorded.
enum class Surface { automatic, recorded };
// The features: the whole dictionary (models/training/trend_rows.h), those of the scene (with `relaxation`), or a list.
enum class FeatureChoice { automatic, scene, given };
enum class FitRecipe { standard, paper_2009 };

struct TrainingRequest {
  FitRecipe recipe = FitRecipe::standard;
  std::string scene;
  std::vector<FeatureSpec> features;  // of the scene: depth, velocity, lowpass_velocity
  JndLine jnd;
  KernelKind kernel = KernelKind::cubic;
  Weighting weighting = Weighting::jnd;
  Reduction reduction = Reduction::coverage;
  FeatureChoice choice = FeatureChoice::scene;
  FeatureList list;  // for FeatureChoice::given
  Relaxation relaxation = Relaxation::scene;
  std::vector<double> relaxation_times_s;  // for Relaxation::given
  std::size_t relaxation_count = 0;        // for Relaxation::automatic: 1 to 3; 0: by cross-validation
  Surface surface = Surface::automatic;
};

// The request of a scene with the recipe of Hoever & Harders (2009), for comparison: reduction by 50 mN; rows scaled by
// 1/f; depth, velocity and low-pass velocities as features; the force itself as target; weights by truncated singular
// values (solve_weights.h); positions as recorded, no trust, an even grid. Two relaxation times are identified from
// these recordings, as the paper identifies its two from the transients of its own (none for a scene without low-pass
// velocities). Forces are limited as in every model, to 1.2 times the largest measured one and to 0, or to the lowest
// one of a material that pulls. Pure.
TrainingRequest recipe_2009_request(TrainingRequest request);

struct PreparedTraining {
  TrainingSet set;
  Sites sites;                                  // normalised; target: the residual of the trend, or the force
  ModelData common;                             // the parts of the model that all methods have in common
  std::vector<PartGain> gains;                  // of each term of the dictionary; empty unless FeatureChoice::automatic
  std::optional<CorrectionChoice> correction;   // none in the paper's recipe
  std::optional<CrossValidationRows> left_out;  // rows for cross-validation; none in the paper's recipe
  std::vector<std::string> notes;               // for the report of every fit

  // False if cross-validation rejected the correction; every method then returns the trend.
  bool corrects() const { return !correction || correction->used; }
};

struct MethodFit {
  ModelData data;
  std::vector<std::string> notes;  // sentences for the user
};

// Errors: those of the recordings; no sample in contact; the request does not suit the scene; interrupted.
Result<PreparedTraining> prepare_training(MotionSource& source, const TrainingRequest& request,
                                          const FitControl& control = {});

// The JND at the force of each site.
Eigen::VectorXd site_thresholds(const PreparedTraining& prepared);

// Fits a method. Deterministic. `base`: a fit of the same prepared training and kernel by the method's base
// (methods.h), which is then not repeated. Errors: the method cannot be fitted to these sites (says why); the forces of
// the model are not finite; interrupted.
Result<MethodFit> fit_method(const PreparedTraining& prepared, const MethodRequest& request,
                             const FitControl& control = {}, const MethodFit* base = nullptr);

}  // namespace palpate
