#include "models/fit/fit.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/text.h"
#include "models/correction/methods.h"
#include "models/fit/bound_estimator.h"

namespace palpate {
namespace {

// The finished fraction of a fit after its choices, and after the method. The fits without each fold follow.
constexpr double kChosen = 0.15;
constexpr double kFitted = 0.6;

// At most this many samples, evenly spaced, for the share of the training within the JND.
constexpr std::size_t kMostEvaluated = 100000;

double share_within_jnd(const PreparedTraining& prepared, const ModelData& data) {
  constexpr std::size_t kParts = 4;
  const FittedModel model(data);
  const Samples& samples = *prepared.samples;
  const std::size_t stride = samples.contact.size() / kMostEvaluated + 1;
  const std::size_t count = (samples.contact.size() + stride - 1) / stride;
  std::array<std::size_t, kParts> within{};
  parallel_for(kParts, [&](int part) {
    const auto p = static_cast<std::size_t>(part);
    for (std::size_t i = count * p / kParts; i < count * (p + 1) / kParts; ++i) {
      const Eigen::VectorXd x = prepared.features.col(static_cast<Eigen::Index>(i * stride));
      const double measured_N = samples.rows[samples.contact[i * stride]].force_N;
      if (data.jnd.error_over_jnd(model.evaluate(x.data()).force_N, measured_N) <= 1.0) ++within[p];
    }
  });
  return static_cast<double>(std::accumulate(within.begin(), within.end(), std::size_t{0})) /
         static_cast<double>(count);
}

MethodTask task_of(const ModelPlan& plan, const Sites& sites, const Eigen::VectorXd& jnd_N, CorrectionPtr base) {
  MethodTask task{sites, jnd_N, plan.centres, plan.candidates, plan.grid, plan.seed, std::move(base)};
  // The number of features is not known before they are selected: those without a size have the last one.
  if (plan.features == FeatureChoice::automatic && !plan.grid.empty())
    task.grid.resize(static_cast<std::size_t>(sites.dimension()), plan.grid.back());
  return task;
}

// The correction without a fold; none if no other fold has rows.
Result<CorrectionPtr> fit_without(const PreparedTraining& prepared, int fold, const ModelPlan& plan,
                                  const FitControl& control) {
  const Sites sites = prepared.left_out->sites_without(fold, prepared.correction->smoothing);
  if (sites.count() == 0) return CorrectionPtr{};
  const Eigen::VectorXd jnd_N = sites.row_scale.cwiseInverse();
  auto fitted = fit_correction(*plan.method, task_of(plan, sites, jnd_N, nullptr), control);
  if (!fitted) return fitted.error();
  return std::move(fitted->correction);
}

// The sites of the selected kernel, normalisation and regularisation.
Sites chosen_sites(const OpenChoices& choices, const PreparedTraining& prepared, ModelData& data) {
  Sites sites = prepared.sites;
  data.scale = prepared.normalisation.scale_of(choices.range_exponent);
  const Eigen::VectorXd factor = prepared.common.scale.cwiseQuotient(data.scale);
  sites.points = factor.asDiagonal() * sites.points;
  data.cover.points = factor.asDiagonal() * data.cover.points;
  sites.kernel = choices.kernel;
  sites.truncation = choices.truncation;
  sites.smoothing = choices.smoothing;
  return sites;
}

}  // namespace

Eigen::VectorXd site_thresholds(const PreparedTraining& prepared) {
  Eigen::VectorXd jnd_N(prepared.sites.count());
  for (Eigen::Index i = 0; i < jnd_N.size(); ++i) jnd_N(i) = prepared.common.jnd.at(prepared.sites.force_N(i));
  return jnd_N;
}

Result<MethodFit> fit_method(const PreparedTraining& prepared, const ModelPlan& plan, const FitControl& control,
                             const MethodFit* base, const OpenChoices* choices) {
  MethodFit fit{prepared.common, {}};
  ModelData& data = fit.data;
  // If cross-validation takes no correction, the model is the trend, and is called so.
  ModelPlan asked = plan;
  if (!prepared.corrects()) asked.method = &kTrendMethod;
  Sites sites = prepared.sites;
  if (plan.base == Base::force) {
    Result<OpenChoices> selected = choices != nullptr ? *choices : OpenChoices{};
    if (choices == nullptr) {
      selected =
          select_open_choices(*prepared.samples, prepared.features, prepared.normalisation, sites, data,
                              plan.selects_centres() ? plan.centres : 0, plan.kernel, control.part(0.0, kChosen));
    }
    if (!selected) return selected.error();
    fit.choices = *selected;
    fit.error_over_jnd = selected->error_over_jnd;
    sites = chosen_sites(*selected, prepared, data);
    fit.notes.push_back(choices_text(*selected));
  }
  const CorrectionPtr from = base == nullptr || asked.method->base == nullptr ? nullptr : base->data.correction;
  const Eigen::VectorXd jnd_N = site_thresholds(prepared);
  auto fitted = fit_correction(*asked.method, task_of(asked, sites, jnd_N, from), control.part(kChosen, kFitted));
  if (!fitted) return fitted.error();
  fit.kernel = sites.kernel;
  fit.rank = fitted->rank;
  fit.condition_number = fitted->condition_number;
  fit.notes.insert(fit.notes.begin(), fitted->notes.begin(), fitted->notes.end());
  if (const auto recorded = prepared.common.provenance.samples; recorded > kMaximumRows) {
    fit.notes.push_back("at most " + std::to_string(kMaximumRows) + " of " + std::to_string(recorded) +
                        " samples were used, evenly spaced");
  }
  if (data.surface_step_N > 0.0) {
    fit.notes.push_back("the recordings never leave the material: above a depth of " +
                        general(1e3 * shallowest_in_domain_m(data), 3) +
                        " mm the model is out of its domain, and at the surface its force steps from 0 to " +
                        general(data.surface_step_N, 3) + " N");
  }
  // The number in the name is that of the centres, of which there may be fewer than planned.
  if (asked.selects_centres()) asked.centres = fitted->correction->size();
  data.method = family_name(asked);
  data.name = plan_name(asked);
  data.provenance.seed = plan.seed;
  data.correction = std::move(fitted->correction);
  if (prepared.left_out) {
    std::vector<CorrectionPtr> of_folds;
    const int folds = data.correction ? prepared.left_out->folds() : 0;
    for (int fold = 0; fold < folds; ++fold) {
      auto of_fold =
          fit_without(prepared, fold, asked, control.part(kFitted + (1.0 - kFitted) * fold / folds, 1.0).at(0.0));
      if (!of_fold) return of_fold.error();
      of_folds.push_back(std::move(*of_fold));
    }
    BoundEstimator bound(data.jnd, data.largest_force_N, prepared.left_out->strokes);
    fit.error_over_jnd = bound.add(*prepared.left_out, data, of_folds).rms_at_mean_score();
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
