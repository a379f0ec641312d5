#include "models/fit/fit.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "engine/base/parallel.h"
#include "models/fit/bound_estimator.h"

namespace palpate {
namespace {

double share_within_jnd(const PreparedTraining& prepared, const ModelData& data) {
  constexpr std::size_t kParts = 4;
  const FittedModel model(data);
  const std::vector<double>& measured_N = prepared.set.evaluation_force_N;
  const std::size_t count = measured_N.size();
  std::array<std::size_t, kParts> within{};
  parallel_for(kParts, [&](int part) {
    const auto p = static_cast<std::size_t>(part);
    for (std::size_t i = count * p / kParts; i < count * (p + 1) / kParts; ++i) {
      const double force_N = model.evaluate(prepared.set.evaluation_features[i].data()).force_N;
      if (data.jnd.error_over_jnd(force_N, measured_N[i]) <= 1.0) ++within[p];
    }
  });
  return static_cast<double>(std::accumulate(within.begin(), within.end(), std::size_t{0})) /
         static_cast<double>(count);
}

// The correction without a fold; none if no other fold has rows.
Result<CorrectionPtr> fit_without(const PreparedTraining& prepared, int fold, const MethodRequest& request,
                                  const FitControl& control) {
  const Sites sites = prepared.left_out->sites_without(fold, prepared.correction->smoothing);
  if (sites.count() == 0) return CorrectionPtr{};
  const Eigen::VectorXd jnd_N = sites.row_scale.cwiseInverse();
  auto fitted = fit_correction({sites, jnd_N, request}, control);
  if (!fitted) return fitted.error();
  return std::move(fitted->correction);
}

}  // namespace

TrainingRequest recipe_2009_request(TrainingRequest request) {
  request.recipe = FitRecipe::paper_2009;
  request.surface = Surface::recorded;
  request.reduction = Reduction::force;
  request.weighting = Weighting::relative;
  request.choice = FeatureChoice::scene;
  const bool relaxes = std::any_of(request.features.begin(), request.features.end(),
                                   [](const FeatureSpec& spec) { return spec.kind == FeatureKind::lowpass_velocity; });
  if (relaxes) {
    request.relaxation = Relaxation::automatic;
    request.relaxation_count = 2;
  }
  return request;
}

Eigen::VectorXd site_thresholds(const PreparedTraining& prepared) {
  Eigen::VectorXd jnd_N(prepared.sites.count());
  for (Eigen::Index i = 0; i < jnd_N.size(); ++i) {
    jnd_N(i) = prepared.common.jnd.at(prepared.set.sites[static_cast<std::size_t>(i)].force_N);
  }
  return jnd_N;
}

Result<MethodFit> fit_method(const PreparedTraining& prepared, const MethodRequest& request, const FitControl& control,
                             const MethodFit* base) {
  const Eigen::VectorXd jnd_N = site_thresholds(prepared);
  // If cross-validation rejected the correction, every method returns the trend, a model without centres.
  MethodRequest asked = request;
  if (!prepared.corrects()) asked.method = &kTrendMethod;
  const CorrectionPtr from = base == nullptr || asked.method->base == nullptr ? nullptr : base->data.correction;
  auto fitted = fit_correction({prepared.sites, jnd_N, asked, from}, control);
  if (!fitted) return fitted.error();
  if (!prepared.corrects() && request.method->can_take(kTakesCentres)) fitted->size = "0";
  MethodFit fit{prepared.common, std::move(fitted->notes)};
  fit.notes.insert(fit.notes.end(), prepared.notes.begin(), prepared.notes.end());
  if (const auto recorded = prepared.common.provenance.samples; recorded > kMaximumRows) {
    fit.notes.push_back("at most " + std::to_string(kMaximumRows) + " of " + std::to_string(recorded) +
                        " samples were used, evenly spaced");
  }
  ModelData& data = fit.data;
  data.method = request.method->name;
  data.name = data.method + (fitted->size.empty() ? "" : "-" + fitted->size);
  data.provenance.seed = request.seed;
  data.correction = std::move(fitted->correction);
  if (prepared.left_out) {
    std::vector<CorrectionPtr> of_folds;
    const int folds = data.correction ? prepared.left_out->folds() : 0;
    for (int fold = 0; fold < folds; ++fold) {
      auto of_fold = fit_without(prepared, fold, request, control);
      if (!of_fold) return of_fold.error();
      of_folds.push_back(std::move(*of_fold));
    }
    BoundEstimator bound(data.jnd, data.largest_force_N, prepared.left_out->strokes);
    bound.add(*prepared.left_out, data, of_folds);
    data.error_bound = bound.fit();
  }
  if (const Status valid = check_forces(data); !valid) {
    return Error{"the " + data.name + " fit did not give a usable model (" + valid.error().message +
                 "); try more smoothing or fewer centres"};
  }
  if (!control.may_continue(0.99)) return interrupted();
  data.provenance.training_within_jnd = share_within_jnd(prepared, data);
  if (!control.may_continue(1.0)) return interrupted();
  return fit;
}

}  // namespace palpate
