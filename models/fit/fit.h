// From recordings to a model: the whole of `palpate fit`, as two steps, so that
// a comparison of methods prepares the data once.
//
//   prepare_training   surface of every recording, greatest depth, relaxation times,
//                      trend, features, normalisation, reduction, one-sided contact, domain cover
//   fit_method         one of the methods of models/fit/methods.h on the prepared sites
//
// The paper's recipe (recipe_2009.h) fits the force itself, without trend, trust and surface search.
// Otherwise the methods fit what the viscoelastic trend leaves over.
// Thread guarantee: slow side.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/base/fit_control.h"
#include "engine/base/result.h"
#include "engine/tick/features.h"
#include "engine/tick/jnd.h"
#include "models/fit/correction_strength.h"
#include "models/fit/methods.h"
#include "models/model/fitted_model.h"
#include "models/training/memory_law.h"
#include "models/training/motion_source.h"
#include "models/training/sites.h"
#include "models/training/training_set.h"
#include "models/training/trend_dictionary.h"
#include "models/training/weighting.h"

namespace palpate {

enum class Relaxation { scene, automatic, given };
// In model files, in the order of the values.
inline constexpr std::array<const char*, 3> kRelaxationNames{"scene", "auto", "given"};
// Where the surface of each recording is: estimated, or 0 as recorded.
enum class Surface { automatic, recorded };
// Which features: the whole dictionary (trend_dictionary.h), the scene's (with
// `relaxation`), or a list.
enum class FeatureChoice { automatic, scene, given };
enum class FitRecipe { standard, paper_2009 };

struct TrainingRequest {
  FitRecipe recipe = FitRecipe::standard;
  std::string scene;
  std::vector<FeatureSpec> features;  // the scene's: depth, velocity, lowpass_velocity
  JndLine jnd;
  Weighting weighting = Weighting::jnd;
  Reduction reduction = Reduction::coverage;
  FeatureChoice choice = FeatureChoice::scene;
  FeatureList list;  // when given
  Relaxation relaxation = Relaxation::scene;
  std::vector<double> relaxation_times_s;  // when given
  std::size_t relaxation_count = 0;        // when automatic: one to three; 0: as many as the recordings support
  Surface surface = Surface::automatic;
};

struct PreparedTraining {
  TrainingSet set;
  Sites sites;                             // normalised; target: what h has to fit
  ModelData common;                        // everything of a model but its method's part
  std::vector<PartGain> gains;             // of each part of the dictionary; empty unless all of it was tried
  std::optional<StrengthChoice> strength;  // of the correction; none for the paper's recipe
  std::optional<LeftOutRows> left_out;     // to cross-validate a method on; likewise
  int folds = 0;
  std::size_t strokes = 0;
  // In-contact feature vectors and forces to evaluate the fit with, at most 100,000.
  std::vector<std::array<double, kMaxFeatures>> evaluation_features;
  std::vector<double> evaluation_force_N;
};

struct MethodFit {
  ModelData data;
  FitReport report;
};

// Errors: those of the recordings; nothing in contact; the request does not fit
// the scene; interrupted.
Result<PreparedTraining> prepare_training(MotionSource& source, const TrainingRequest& request,
                                          const FitControl& control = {});

// The JND at the force of each site.
Eigen::VectorXd site_thresholds(const PreparedTraining& prepared);

// Errors: the method cannot be fitted to these sites (says why); interrupted.
// The same prepared training and request give the same bits. `base`: the fit of the
// same prepared training and kernel by the method's base (methods.h), when
// there is one already, which then is not fitted again.
Result<MethodFit> fit_method(const PreparedTraining& prepared, const MethodRequest& request,
                             const FitControl& control = {}, const MethodFit* base = nullptr);

}  // namespace palpate
