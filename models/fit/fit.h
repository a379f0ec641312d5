// The fit of a model to the samples of recordings (`palpate fit`), in two steps, so that plans that differ in the
// method only share the first.
//   prepare_training   features, trend, normalisation, thinned sites, domain, whether the correction is used
//   fit_method         one of the methods of models/correction/methods.h on the prepared sites
// With Base::trend the methods fit the residual of the trend. With Base::force they fit the measured force, as Hoever &
// Harders (2009), and what the paper leaves open is selected by cross-validation (OpenChoices).
// Thread guarantee: slow side.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "models/fit/model_plan.h"
#include "models/fit/residual_rows.h"
#include "models/model/fitted_model.h"
#include "models/trend/trend_estimator.h"

namespace palpate {

using SamplesPointer = std::shared_ptr<const Samples>;

// What a scene gives to a fit.
struct TrainingScene {
  std::string name;
  std::vector<FeatureSpec> features;  // depth, velocity, lowpass_velocity
  JndLine jnd;
};

// Selects what Hoever & Harders (2009) leave open for a fit to the measured force, by cross-validation: the order of
// the polyharmonic kernel, the normalisation of the features, and the regularisation.
//
// Normalisation divides feature k by range_k^a (4 sigma_k)^(1 - a), with a = 1/2 or 1. Methods that select centres are
// regularised by the truncation of their pseudo-inverse (eq. 8), and the direct interpolation by the smoothing of its
// Cholesky factor, which takes the place of the truncated pseudo-inverse of eq. 4: the first is a step and the second
// lambda / (lambda + smoothing) over the eigenvalues lambda (Hansen 1998, section 4.2).
//
// Each candidate is fitted on random centres to the sites outside of a fold and predicts the samples in contact of that
// fold (models/samples/selection.h). The lowest score wins.
struct OpenChoices {
  KernelKind kernel = KernelKind::cubic;
  double range_exponent = 0.5;  // a
  double truncation = 0.0;      // of methods that select centres
  double smoothing = 0.0;       // of the direct interpolation
  double error_over_jnd = 0.0;  // cross-validated (FoldErrors::rms_at_mean_score)
};

// "cubic kernel, normalised by ...": what was selected, for the user.
std::string choices_text(const OpenChoices& choices, bool has_kernel = true);
// `features`: at the samples in contact, SI. `sites`: of the same samples, with targets. `common`: with the limits of
// the force. `centres`: of the method, 0: the direct interpolation. `kernel`: that of the plan, none: selected. Errors:
// interrupted.
Result<OpenChoices> select_open_choices(const Samples& samples, const Eigen::MatrixXd& features,
                                        const Normalisation& normalisation, const Sites& sites, const ModelData& common,
                                        int centres, std::optional<KernelKind> kernel, const FitControl& control);

struct PreparedTraining {
  SamplesPointer samples;
  Eigen::MatrixXd features;                    // at the samples in contact, one column each, SI
  Sites sites;                                 // target: the residual of the trend, or the force
  double thinning_force_N = 0.0;               // the step of Thinning::force
  ModelData common;                            // the parts of the model that all methods have in common
  std::vector<PartGain> gains;                 // of each term of the dictionary; empty unless the features are selected
  std::optional<CorrectionChoice> correction;  // of the residual of the trend; none with Base::force
  std::optional<ResidualRows> left_out;        // by units; none of a single one, or with Base::force

  // False if cross-validation rejected the correction; every method then returns the trend.
  bool corrects() const { return !correction || correction->used; }
};

struct MethodFit {
  ModelData data;
  std::vector<std::string> notes;        // sentences for the user
  std::optional<KernelKind> kernel{};    // of a method that takes one
  std::optional<OpenChoices> choices{};  // with Base::force
  double error_over_jnd = 0.0;           // cross-validated: of the choices, or of the rows that were left out
  Eigen::Index rank = 0;                 // as in FittedCorrection
  double condition_number = 0.0;
  double seconds = 0.0;  // of ModelFits::fit: with its base, without the preparation
};

// Errors: the plan does not suit the scene; interrupted.
Result<PreparedTraining> prepare_training(SamplesPointer samples, const TrainingScene& scene, const ModelPlan& plan,
                                          const FitControl& control = {});
// The JND at the force of each site.
Eigen::VectorXd site_thresholds(const PreparedTraining& prepared);
// Fits the method of a plan with this preparation. Deterministic. `base`: a fit with the same preparation by the base
// of the method (methods.h), which is then not repeated. `choices`: those of a fit with this preparation and number of
// centres. Errors: the method cannot be fitted to these sites (says why); the forces of the model are not finite;
// interrupted.
Result<MethodFit> fit_method(const PreparedTraining& prepared, const ModelPlan& plan, const FitControl& control = {},
                             const MethodFit* base = nullptr, const OpenChoices* choices = nullptr);

// The JSON object that `palpate fit --json` prints.
nlohmann::ordered_json fit_json(const MethodFit& fit, double seconds);

// The fits of several plans to the same recordings: what plans have in common is done once.
class ModelFits {
 public:
  ModelFits(std::vector<PreparedRecordingPointer> recordings, TrainingScene scene)
      : recordings_(std::move(recordings)), scene_(std::move(scene)) {}
  ModelFits(SamplesPointer samples, TrainingScene scene) : scene_(std::move(scene)), samples_(std::move(samples)) {}

  // The samples of the recordings. Errors: those of make_samples.
  Result<SamplesPointer> samples(const FitControl& control);
  // The preparation of a plan. Valid while this lives. Errors: those of make_samples and prepare_training.
  Result<const PreparedTraining*> prepare(const ModelPlan& plan, const FitControl& control);

  // Prepares the plan, if that has not been done, and fits its method. Errors: those of prepare and fit_method.
  Result<MethodFit> fit(const ModelPlan& plan, const FitControl& control);

 private:
  const PreparedTraining* prepared_for(const ModelPlan& plan) const;  // null: not prepared

  std::vector<PreparedRecordingPointer> recordings_;
  TrainingScene scene_;
  SamplesPointer samples_;
  std::vector<std::pair<ModelPlan, std::unique_ptr<PreparedTraining>>> prepared_;
  std::vector<std::pair<ModelPlan, MethodFit>> fits_;  // to start others from
};

}  // namespace palpate
