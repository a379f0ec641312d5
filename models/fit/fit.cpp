#include "models/fit/fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/text.h"
#include "models/correction/methods.h"

namespace palpate {
namespace {

bool selects_features(const ModelPlan& plan) {
  return plan.base == Base::trend && plan.features == FeatureChoice::automatic;
}

// Depth and velocity of these features, with low-passes of these times.
std::vector<FeatureSpec> with_filters(std::vector<FeatureSpec> features, const std::vector<double>& times_s) {
  std::erase_if(features, [](const FeatureSpec& spec) {
    return spec.kind != FeatureKind::depth && spec.kind != FeatureKind::velocity;
  });
  for (const double time_s : times_s) features.push_back({FeatureKind::lowpass_velocity, time_s, {}});
  return features;
}

// The scene's features, of the paper's methods with two identified relaxation times.
Result<FeatureList> scene_list(const Samples& samples, const TrainingScene& scene, const ModelPlan& plan,
                               const FitControl& control) {
  const bool velocity = has_kind(scene.features, FeatureKind::velocity);
  const std::vector<double> times_s = relaxation_times_s(scene.features);
  if (plan.features == FeatureChoice::scene || times_s.empty()) return single_times(velocity, times_s);
  const auto identified = identify_relaxation(samples, scene.jnd, velocity, 2, control);
  if (!identified) return identified.error();
  return single_times(velocity, *identified);
}

// The gain of each part of the list: the cross-validated error with it and without it.
void add_gains(std::vector<PartGain>& gains, const TrendColumns& columns, const TrendEstimator& estimator,
               const CrossValidated& with_all, const Eigen::VectorXd& x) {
  const auto& features = columns.list().features;
  for (std::size_t f = 1; f < features.size(); ++f) {  // after the depth
    const auto others = columns.columns_of([f](std::size_t other) { return other != f; });
    const bool taken = (x(columns.feature_columns()[f]).array() > 0.0).any();
    gains.push_back({term_name(features[f]), taken, with_all.errors.rms_at_mean_score(),
                     estimator.cross_validate(others).errors.rms_at_mean_score()});
  }
  std::stable_partition(gains.begin(), gains.end(), [](const PartGain& one) { return one.taken; });
}

// The trend, and the features with the drive curves that its regression determines.
struct TrendFit {
  TrendColumns columns;
  FittedTrend fitted;
  Eigen::MatrixXd left_out;  // the weights of the trends fitted without each fold
  double smoothness = 0.0;
};

Result<TrendFit> fit_trend(const Samples& samples, FeatureList list, const JndLine& jnd, bool selects,
                           std::vector<PartGain>& gains, const FitControl& control) {
  // Enough rows to average out the noise.
  auto columns = TrendColumns::make(samples, std::move(list), 8000, control);
  if (!columns) return columns.error();
  const TrendEstimator estimator(*columns, jnd);
  const CrossValidated left_out = estimator.cross_validate(estimator.all_columns());
  const Eigen::VectorXd x = estimator.fit(estimator.all_columns());
  if (selects) add_gains(gains, *columns, estimator, left_out, x);
  FittedTrend fitted = fitted_trend(*columns, x, !selects);
  return TrendFit{std::move(*columns), std::move(fitted), left_out.solutions, estimator.smoothness()};
}

// Targets and factors of the sites, their cover, and the limit of the correction.
void finish_sites(PreparedTraining& prepared, const ModelPlan& plan) {
  ModelData& common = prepared.common;
  Sites& sites = prepared.sites;
  sites.kernel = plan.kernel.value_or(KernelKind::cubic);
  const double no_force_N = prepared.samples->no_force_N();
  for (Eigen::Index k = 0; k < sites.count(); ++k) {
    const Eigen::VectorXd x = common.offset + common.scale.cwiseProduct(sites.points.col(k));
    const double trend_N = common.trend.at(x.data(), common.features);
    const double force_N = sites.force_N(k);
    // Where no force is measured and the trend is below 0, no correction is needed.
    const bool needless = std::abs(force_N) <= no_force_N && trend_N < 0.0;
    sites.target_N(k) = needless ? 0.0 : force_N - trend_N;
    // With the force, eq. 8 of the paper. The mean of n errors of a JND is one of 1 / sqrt(n) JND: it counts until it
    // is kUnnoticed_jnd, with 16 samples of a dwell.
    const double unit_N =
        plan.base == Base::trend ? common.jnd.at(force_N) : std::max(std::abs(force_N), kReductionForce_N);
    sites.row_scale(k) = 1.0 / unit_N * std::min(std::sqrt(sites.samples(k)), 1.0 / kUnnoticed_jnd);
  }
  common.cover = make_cover(sites.points);
  common.correction_limit_N =
      std::min(1.1 * sites.target_N.lpNorm<Eigen::Infinity>(), kMaximumForce_N);  // that of a model file
  if (plan.base == Base::trend) return;
  // The paper uses its function everywhere, within the limits of the force only.
  common.cover.inner_radius = kEverywhere;
  common.cover.outer_radius = 2.0 * kEverywhere;
  common.correction_limit_N = kForceMargin * std::max(common.largest_force_N, -common.lowest_force_N);
}

void set_provenance(PreparedTraining& prepared, const TrainingScene& scene, const ModelPlan& plan) {
  const Samples& samples = *prepared.samples;
  Provenance& provenance = prepared.common.provenance;
  provenance.offsets = samples.offsets;
  for (const RecordingOffset& one : samples.offsets) provenance.recordings.push_back(one.name);
  provenance.scene = scene.name;
  provenance.samples = samples.recorded_rows;
  provenance.contact_samples = samples.contact.size();
  provenance.samples_after_reduction = static_cast<std::uint64_t>(prepared.sites.count());
  provenance.weighting = plan.base == Base::trend ? "jnd" : "relative";
  provenance.thinning = kThinningNames[static_cast<std::size_t>(plan.thins())];
  constexpr const char* kFeatureNames[] = {"auto", "scene", "given"};
  provenance.relaxation = kFeatureNames[static_cast<std::size_t>(plan.features)];
}

// Root mean square of the errors over the JND at the predicted force.
double mean_error_over_jnd(const std::vector<Prediction>& predictions, const JndLine& jnd) {
  double squares = 0.0;
  for (const Prediction& one : predictions) squares += std::pow(one.error_N / jnd.at(one.predicted_N), 2);
  return predictions.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(predictions.size()));
}

// The finished fraction of a fit after its choices, and after the method. The fits without each fold follow.
constexpr double kChosen = 0.15;
constexpr double kFitted = 0.6;

// The approximate time of the preparation, to compare with the expected time of the method.
constexpr double kPreparation_s = 0.5;

// The share of the training within the JND, of at most 100,000 samples, evenly spaced.
double share_within_jnd(const PreparedTraining& prepared, const ModelData& data) {
  const FittedModel model(data);
  const Samples& samples = *prepared.samples;
  double within = 0.0, count = 0.0;
  for (std::size_t i = 0; i < samples.contact.size(); i += samples.contact.size() / 100000 + 1) {
    const Eigen::VectorXd x = prepared.features.col(static_cast<Eigen::Index>(i));
    const double measured_N = samples.rows[samples.contact[i]].force_N;
    if (data.jnd.error_over_jnd(model.force(x.data()), measured_N) <= 1.0) within += 1.0;
    count += 1.0;
  }
  return within / count;
}

MethodTask task_of(const ModelPlan& plan, const Sites& sites, const Eigen::VectorXd& jnd_N, CorrectionPtr base) {
  return {sites, jnd_N, plan.centres, plan.candidates, plan.grid, plan.seed, std::move(base)};
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
  data.scale = prepared.common.scale_of(choices.range_exponent);
  const Eigen::VectorXd factor = prepared.common.scale.cwiseQuotient(data.scale);
  sites.points = factor.asDiagonal() * sites.points;
  data.cover.points = factor.asDiagonal() * data.cover.points;
  sites.kernel = choices.kernel;
  sites.truncation = choices.truncation;
  sites.smoothing = choices.smoothing;
  return sites;
}

}  // namespace

Result<PreparedTraining> prepare_training(SamplesPointer samples, const TrainingScene& scene, const ModelPlan& plan,
                                          const FitControl& control) {
  PreparedTraining prepared;
  prepared.samples = std::move(samples);
  const Samples& table = *prepared.samples;
  auto list = plan.features == FeatureChoice::given ? Result<FeatureList>(plan.list)
              : selects_features(plan)
                  ? select_slowing(table, scene.jnd, dictionary(table), prepared.gains, control.at(0.1))
                  : scene_list(table, scene, plan, control.at(0.1));
  if (!list) return list.error();
  ModelData& common = prepared.common;
  common.jnd = scene.jnd;
  common.largest_force_N = table.force_N;
  common.lowest_force_N = table.lowest_force_N;
  common.sensor = table.sensor;
  if (table.always_N > scene.jnd.at(0.0)) common.surface_step_N = table.always_N;
  common.trend.reference_depth_m = table.depth_m;
  std::optional<TrendFit> trend;
  if (plan.base == Base::trend) {
    auto fitted =
        fit_trend(table, std::move(*list), scene.jnd, selects_features(plan), prepared.gains, control.at(0.3));
    if (!fitted) return fitted.error();
    trend = std::move(*fitted);
    common.trend = trend->fitted.trend;
    common.features = trend->fitted.features;
  } else {
    const auto& kinds = plan.features == FeatureChoice::given ? plan.list.features : scene.features;
    common.features = with_filters(kinds, relaxation_times_s(list->features));
  }
  auto features = features_at(table, common.features, table.contact, control.at(0.6));
  if (!features) return features.error();
  prepared.features = std::move(*features);
  static_cast<Normalisation&>(common) = normalisation_of(prepared.features);
  prepared.sites = thin(table, prepared.features, common, plan.thins(), prepared.thinning_force_N);
  finish_sites(prepared, plan);
  if (!control.may_continue(0.7)) return interrupted();
  if (trend) {
    ResidualRows rows = residual_rows(common, trend->columns, prepared.features, trend->left_out);
    rows.kernel = prepared.sites.kernel;
    const CorrectionChoice choice = choose_correction(rows, common);
    prepared.correction = choice;
    trend->columns.leave_out_units();
    if (table.offsets.size() < 3 && trend->columns.folds() > 1) {  // else they are the folds, or there is one
      const TrendEstimator estimator(trend->columns, scene.jnd, trend->smoothness);
      rows = residual_rows(common, trend->columns, prepared.features,
                           estimator.cross_validate(estimator.all_columns()).solutions);
      rows.kernel = prepared.sites.kernel;
    }
    if (trend->columns.folds() > 1) prepared.left_out = std::move(rows);
    prepared.sites.smoothing = choice.smoothing;
    common.cover.outer_radius *= choice.inner_radius / common.cover.inner_radius;
    common.cover.inner_radius = choice.inner_radius;
  }
  common.ends = recording_ends(table, common.features);
  // A model takes positions in the coordinate of its recordings.
  for (FeatureSpec& spec : common.features)
    if (spec.kind == FeatureKind::depth) spec.surface_position_m = table.surface_m;
  set_provenance(prepared, scene, plan);
  if (!control.may_continue(1.0)) return interrupted();
  return prepared;
}

Result<MethodFit> fit_method(const PreparedTraining& prepared, const ModelPlan& plan, const FitControl& control,
                             const MethodFit* base, const OpenChoices* choices) {
  MethodFit fit;
  ModelData data = prepared.common;
  // If cross-validation takes no correction, the model is the trend, and is called so.
  ModelPlan asked = plan;
  if (!prepared.corrects()) asked.method = &kTrendMethod;
  Sites sites = prepared.sites;
  if (plan.base == Base::force) {
    Result<OpenChoices> selected = choices != nullptr ? *choices : OpenChoices{};
    if (choices == nullptr) {
      selected =
          select_open_choices(*prepared.samples, prepared.features, prepared.common, sites, data,
                              plan.selects_centres() ? plan.centres : 0, plan.kernel, control.part(0.0, kChosen));
    }
    if (!selected) return selected.error();
    fit.choices = *selected;
    fit.error_over_jnd = selected->error_over_jnd;
    sites = chosen_sites(*selected, prepared, data);
    fit.notes.push_back(choices_text(*selected, asked.method->can_take(kTakesKernel)) +
                        (asked.method->can_take(kTakesGrid) ? " of the interpolant, before the grid" : ""));
  }
  const CorrectionPtr from =
      base == nullptr || asked.method->base == nullptr ? nullptr : base->model->data().correction;
  const Eigen::VectorXd jnd_N = sites.force_N.unaryExpr([&](double force_N) { return data.jnd.at(force_N); });
  auto fitted = fit_correction(*asked.method, task_of(asked, sites, jnd_N, from), control.part(kChosen, kFitted));
  if (!fitted) return fitted.error();
  if (asked.method->can_take(kTakesKernel)) fit.kernel = sites.kernel;
  fit.rank = fitted->rank;
  fit.condition_number = fitted->condition_number;
  fit.notes.insert(fit.notes.begin(), fitted->notes.begin(), fitted->notes.end());
  if (const auto recorded = prepared.common.provenance.samples; recorded > kMaximumRows) {
    fit.notes.push_back("at most " + std::to_string(kMaximumRows) + " of " + std::to_string(recorded) +
                        " samples were used, evenly spaced");
  }
  if (data.surface_step_N > 0.0) {
    fit.notes.push_back("the recordings never leave the material: above a depth of " +
                        general(1e3 * FittedModel(data).shallowest_m(), 3) +
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
    const std::vector<Prediction> predictions = predictions_of(*prepared.left_out, data, of_folds);
    data.error_bound = fit_bound(predictions, data);
    fit.error_over_jnd = mean_error_over_jnd(predictions, data.jnd);
  }
  if (const Status valid = check_forces(data); !valid) {
    return Error{"the " + data.name + " fit did not give a usable model (" + valid.error().message +
                 "); try more smoothing or fewer centres"};
  }
  if (!control.may_continue(0.99)) return interrupted();
  data.provenance.training_within_jnd = share_within_jnd(prepared, data);
  fit.model = std::make_shared<const FittedModel>(std::move(data));
  if (!control.may_continue(1.0)) return interrupted();
  return fit;
}

nlohmann::ordered_json fit_json(const MethodFit& fit, double seconds) {
  using Json = nlohmann::ordered_json;
  const ModelData& data = fit.model->data();
  Json features = Json::array(), recordings = features;
  for (const FeatureSpec& spec : data.features) features.push_back(feature_name(spec));
  for (const RecordingOffset& one : data.provenance.offsets) {
    recordings.push_back({{"name", one.name},
                          {"surface_offset_m", one.offset_m},
                          {"standard_error_m", one.standard_error_m},  // not finite: null
                          {"identified", std::isfinite(one.standard_error_m)},
                          {"force_zero_N", one.force_zero_N}});
  }
  return {{"name", data.name},
          {"method", data.method},
          {"centres", data.centre_count()},
          {"kernel", fit.kernel ? Json(kernel_name(*fit.kernel)) : Json()},  // without one: null
          {"weighting", data.provenance.weighting},
          {"samples", data.provenance.samples},
          {"samples_after_reduction", data.provenance.samples_after_reduction},
          {"rank", fit.rank > 0 ? Json(fit.rank) : Json()},  // without equations: null
          {"condition_number", fit.rank > 0 ? Json(fit.condition_number) : Json()},
          {"fit_seconds", seconds},
          {"training_within_jnd", data.provenance.training_within_jnd},
          {"features", features},
          {"recordings", recordings},
          {"notes", fit.notes}};
}

Result<SamplesPointer> ModelFits::samples(const FitControl& control) {
  if (samples_ == nullptr) {
    auto made = make_samples(recordings_, scene_.jnd, control);
    if (!made) return made.error();
    samples_ = std::make_shared<const Samples>(std::move(*made));
  }
  return samples_;
}

const PreparedTraining* ModelFits::prepared_for(const ModelPlan& plan) const {
  for (const auto& [other, prepared] : prepared_)
    if (same_preparation(plan, other)) return prepared.get();
  return nullptr;
}

Result<const PreparedTraining*> ModelFits::prepare(const ModelPlan& plan, const FitControl& control) {
  if (const PreparedTraining* const done = prepared_for(plan)) return done;
  const auto table = samples(control.at(0.0));
  if (!table) return table.error();
  auto made = prepare_training(*table, scene_, plan, control);
  if (!made) return made.error();
  prepared_.emplace_back(plan, std::make_unique<PreparedTraining>(std::move(*made)));
  return prepared_.back().second.get();
}

Result<MethodFit> ModelFits::fit(const ModelPlan& plan, const FitControl& control) {
  const double all_s = kPreparation_s + expected_seconds(*plan.method);
  const double prepared_at = prepared_for(plan) == nullptr ? kPreparation_s / all_s : 0.0;
  const auto prepared = prepare(plan, control.part(0.0, prepared_at));
  if (!prepared) return prepared.error();
  const MethodFit* base = nullptr;
  const OpenChoices* choices = nullptr;
  double seconds = 0.0;
  for (const auto& [other, fit] : fits_) {
    if (!same_preparation(plan, other) || plan.kernel != other.kernel) continue;
    const bool same_size =
        plan.selects_centres() == other.selects_centres() && (!plan.selects_centres() || plan.centres == other.centres);
    if (fit.choices && same_size) choices = &*fit.choices;
    if (plan.method->base != other.method) continue;
    base = &fit;
    seconds = fit.seconds;
  }
  const auto start = std::chrono::steady_clock::now();
  auto made = fit_method(**prepared, plan, control.part(prepared_at, 1.0), base, choices);
  if (!made) return made.error();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  MethodFit& fit = *made;
  fit.seconds = elapsed.count() + seconds;
  const bool starts_others =
      std::ranges::any_of(methods(), [&](const Method* one) { return one->base == plan.method; });
  const bool has_choices = fit.choices && choices == nullptr;
  if (starts_others || has_choices) fits_.emplace_back(plan, fit);
  return fit;
}

}  // namespace palpate
