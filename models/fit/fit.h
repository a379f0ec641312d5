// The fit of a model to recordings (`palpate fit`), in two steps, so that a comparison of methods prepares the data
// once.
//
//   prepare_training   surfaces, greatest depth, relaxation times, trend, features, normalisation, reduction,
//                      one-sided contact, domain cover, whether the correction is used
//   fit_method         one of the methods of models/fit/methods.h on the prepared sites
//
// With Base::trend the methods fit the residual of the trend. With Base::force they fit the measured force, as Hoever &
// Harders (2009): the scene's features with two identified relaxation times, the 50 mN reduction, rows scaled by 1 / f,
// no trend, no trust, positions as recorded. What the paper leaves open is selected by cross-validation
// (open_choices.h). Forces are limited as in every model, to 1.2 times the largest measured one and to 0, or to the
// lowest one of a material that pulls. Thread guarantee: slow side.
#pragma once

#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/fit/correction_choice.h"
#include "models/fit/methods.h"
#include "models/fit/open_choices.h"
#include "models/model/fitted_model.h"
#include "models/training/memory_law.h"
#include "models/training/sites.h"
#include "models/training/training_set.h"

namespace palpate {

// What a scene gives to a fit.
struct TrainingScene {
  std::string name;
  std::vector<FeatureSpec> features;  // depth, velocity, lowpass_velocity
  JndLine jnd;
};

struct PreparedTraining {
  TrainingSet set;
  Sites sites;                                  // normalised; target: the residual of the trend, or the force
  ModelData common;                             // the parts of the model that all methods have in common
  std::vector<PartGain> gains;                  // of each term of the dictionary; empty unless FeatureChoice::automatic
  std::optional<CorrectionChoice> correction;   // of the residual of the trend; none with Base::force
  std::optional<CrossValidationRows> left_out;  // rows for cross-validation; none with Base::force
  std::vector<std::string> notes;               // for the report of every fit

  // False if cross-validation rejected the correction; every method then returns the trend.
  bool corrects() const { return !correction || correction->used; }
};

struct MethodFit {
  ModelData data;
  std::vector<std::string> notes;  // sentences for the user
  KernelKind kernel = KernelKind::cubic;
  std::optional<OpenChoices> choices{};  // with Base::force
  double error_over_jnd = 0.0;           // cross-validated (FoldErrors::rms_at_mean_score)
  Eigen::Index rank = 0;                 // as in FittedCorrection
  double condition_number = 0.0;
};

// Errors: those of the recordings; no sample in contact; the plan does not suit the scene; interrupted.
Result<PreparedTraining> prepare_training(MotionSource& source, const TrainingScene& scene, const ModelPlan& plan,
                                          const FitControl& control = {});

// The JND at the force of each site.
Eigen::VectorXd site_thresholds(const PreparedTraining& prepared);

// Fits the method of a plan with this preparation. Deterministic. `base`: a fit with the same preparation by the base
// of the method (methods.h), which is then not repeated. `choices`: those of a fit with this preparation and number of
// centres. Errors: the method cannot be fitted to these sites (says why); the forces of the model are not finite;
// interrupted.
Result<MethodFit> fit_method(const PreparedTraining& prepared, const ModelPlan& plan, const FitControl& control = {},
                             const MethodFit* base = nullptr, const OpenChoices* choices = nullptr);

}  // namespace palpate
