#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/recording/recording_rules.h"
#include "models/fit/fit.h"
#include "models/trend/trend_estimator.h"

namespace palpate {
namespace {

constexpr double kCorrectionMargin = 1.1;
// Rows of the trend's regression, enough to average out the noise.
constexpr std::size_t kTrendRows = 8000;
// A dwell of many samples counts as at most this many.
constexpr double kMaximumSiteCount = 16.0;
// The number of relaxation times of the paper.
constexpr std::size_t kPapersTimes = 2;

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

// The scene's features with the relaxation times of the scene, of the plan, or identified ones.
Result<FeatureList> scene_list(const Samples& samples, const TrainingScene& scene, const ModelPlan& plan,
                               const FitControl& control) {
  const bool velocity = has_kind(scene.features, FeatureKind::velocity);
  const std::vector<double> times_s = relaxation_times_s(scene.features);
  const bool papers = plan.features == FeatureChoice::automatic;
  if (!papers && plan.relaxation == Relaxation::scene) return single_times(velocity, times_s);
  if (times_s.empty()) {
    if (papers) return single_times(velocity, times_s);
    return Error{"scene \"" + scene.name +
                 "\" has no relaxation features; leave out --relaxation, or use a scene "
                 "that has them (palpate scenes)"};
  }
  if (!papers && plan.relaxation == Relaxation::given) return single_times(velocity, plan.relaxation_times_s);
  const auto identified = identify_relaxation(samples, {scene.jnd}, velocity, papers ? kPapersTimes : 0, control);
  if (!identified) return identified.error();
  return single_times(velocity, *identified);
}

Result<FeatureList> feature_list(const Samples& samples, const TrainingScene& scene, const ModelPlan& plan,
                                 std::vector<PartGain>& gains, const FitControl& control) {
  if (plan.features == FeatureChoice::given) return plan.list;
  if (!selects_features(plan)) return scene_list(samples, scene, plan, control);
  return select_memory_law(samples, {scene.jnd, plan.weights()}, dictionary(samples), gains, control);
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
};

Result<TrendFit> fit_trend(const Samples& samples, FeatureList list, const TrendWeights& weights, bool selects,
                           std::vector<PartGain>& gains, const FitControl& control) {
  auto columns = TrendColumns::make(samples, std::move(list), kTrendRows, control);
  if (!columns) return columns.error();
  const TrendEstimator estimator(*columns, weights);
  const CrossValidated left_out = estimator.cross_validate(estimator.all_columns());
  const Eigen::VectorXd x = estimator.fit(estimator.all_columns());
  if (selects) add_gains(gains, *columns, estimator, left_out, x);
  FittedTrend fitted = fitted_trend(*columns, x, !selects);
  return TrendFit{std::move(*columns), std::move(fitted), left_out.solutions};
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
    sites.row_scale(k) =
        row_scale(plan.weights(), common.jnd, force_N) * std::sqrt(std::min(sites.samples(k), kMaximumSiteCount));
  }
  common.cover = make_cover(sites.points);
  common.correction_limit_N =
      std::min(kCorrectionMargin * sites.target_N.lpNorm<Eigen::Infinity>(), kMaximumForce_N);  // that of a model file
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
  provenance.weighting = kWeightingNames[static_cast<std::size_t>(plan.weights())];
  provenance.thinning = kThinningNames[static_cast<std::size_t>(plan.thins())];
  const Relaxation relaxation = plan.features == FeatureChoice::automatic ? Relaxation::automatic
                                : plan.features == FeatureChoice::given   ? Relaxation::given
                                                                          : plan.relaxation;
  provenance.relaxation = kRelaxationNames[static_cast<std::size_t>(relaxation)];
}

}  // namespace

Result<PreparedTraining> prepare_training(SamplesPointer samples, const TrainingScene& scene, const ModelPlan& plan,
                                          const FitControl& control) {
  PreparedTraining prepared;
  prepared.samples = std::move(samples);
  const Samples& table = *prepared.samples;
  auto list = feature_list(table, scene, plan, prepared.gains, control.at(0.1));
  if (!list) return list.error();
  ModelData& common = prepared.common;
  common.jnd = scene.jnd;
  common.largest_force_N = table.force_N;
  common.lowest_force_N = table.lowest_force_N;
  common.sensor = table.sensor;
  if (table.always_N > scene.jnd.at(0.0)) common.surface_step_N = table.always_N;
  common.trend.reference_depth_m = table.depth_m;
  const TrendWeights weights{scene.jnd, plan.weights()};
  std::optional<TrendFit> trend;
  if (plan.base == Base::trend) {
    auto fitted = fit_trend(table, std::move(*list), weights, selects_features(plan), prepared.gains, control.at(0.3));
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
  prepared.normalisation = normalisation_of(prepared.features);
  common.offset = prepared.normalisation.offset;
  common.scale = prepared.normalisation.scale;
  common.lower = prepared.normalisation.lower;
  common.upper = prepared.normalisation.upper;
  prepared.sites = thin(table, prepared.features, prepared.normalisation, plan.thins(), prepared.thinning_force_N);
  finish_sites(prepared, plan);
  if (!control.may_continue(0.7)) return interrupted();
  if (trend) {
    prepared.left_out = residual_rows(common, trend->columns, weights, prepared.features, trend->left_out);
    prepared.left_out->kernel = prepared.sites.kernel;
    const CorrectionChoice choice = choose_correction(*prepared.left_out, common);
    prepared.correction = choice;
    prepared.sites.smoothing = choice.smoothing;
    const double outer_to_inner = common.cover.outer_radius / common.cover.inner_radius;
    common.cover.inner_radius = choice.inner_radius;
    common.cover.outer_radius = outer_to_inner * choice.inner_radius;
  }
  // A model takes positions in the coordinate of its recordings.
  for (FeatureSpec& spec : common.features) {
    if (spec.kind == FeatureKind::depth) spec.surface_position_m = table.surface_m;
  }
  set_provenance(prepared, scene, plan);
  if (!control.may_continue(1.0)) return interrupted();
  return prepared;
}

}  // namespace palpate
