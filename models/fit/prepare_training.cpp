#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/tick/sensor_identification.h"
#include "models/fit/fit.h"
#include "models/surface/surface_registration.h"

namespace palpate {
namespace {

constexpr double kCorrectionMargin = 1.1;
// Rows of the trend's regression, enough to average out the noise.
constexpr std::size_t kTrendRows = 8000;
// A dwell of many samples counts as at most this many.
constexpr double kMaximumSiteCount = 16.0;
// The radius of a trust that is 1 everywhere: normalised features are about 1.
constexpr double kEverywhere = 1e6;
// The number of relaxation times of the paper.
constexpr std::size_t kPapersTimes = 2;

bool selects_features(const ModelPlan& plan) {
  return plan.base == Base::trend && plan.features == FeatureChoice::automatic;
}

// These features with low-passes of these times.
std::vector<FeatureSpec> with_filters(std::vector<FeatureSpec> features, const std::vector<double>& times_s) {
  std::erase_if(features, [](const FeatureSpec& spec) {
    return spec.kind != FeatureKind::depth && spec.kind != FeatureKind::velocity;
  });
  for (const double time_s : times_s) features.push_back({FeatureKind::lowpass_velocity, time_s, {}});
  return features;
}

// The sites of the reduced samples, their cover and the limit of the correction.
void make_sites(PreparedTraining& prepared, const ModelPlan& plan) {
  ModelData& common = prepared.common;
  const auto n = static_cast<Eigen::Index>(prepared.set.sites.size());
  const auto d = static_cast<Eigen::Index>(common.features.size());
  Sites& sites = prepared.sites;
  sites = {Eigen::MatrixXd(d, n), Eigen::VectorXd(n), Eigen::VectorXd(n), plan.kernel.value_or(KernelKind::cubic)};
  double largest_N = 0.0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const TrainingSite& site = prepared.set.sites[static_cast<std::size_t>(k)];
    const Eigen::Map<const Eigen::VectorXd> x(site.features.data(), d);
    sites.points.col(k) = (x - common.offset).cwiseQuotient(common.scale);
    const double trend_N = common.trend.at(site.features.data(), common.features);
    // Where no force is measured and the trend is below 0, no correction is needed.
    const bool needless = site.no_force && trend_N < 0.0;
    sites.target_N(k) = needless ? 0.0 : site.force_N - trend_N;
    sites.row_scale(k) =
        row_scale(plan.weights(), common.jnd, site.force_N) * std::sqrt(std::min(site.count, kMaximumSiteCount));
    largest_N = std::max(largest_N, std::abs(sites.target_N(k)));
  }
  common.cover = make_cover(sites.points);
  common.correction_limit_N = kCorrectionMargin * largest_N;
  if (plan.base == Base::trend) return;
  // The paper uses its function everywhere, within the limits of the force only.
  common.cover.inner_radius = kEverywhere;
  common.cover.outer_radius = 2.0 * kEverywhere;
  common.correction_limit_N = kForceMargin * std::max(common.largest_force_N, -common.lowest_force_N);
}

// The recordings with the corrections of the registration that are used.
struct CorrectedRecordings {
  std::vector<RecordingSurface> surfaces{};  // empty: as recorded
  double surface_m = 0.0;                    // position of the surface, in positions as recorded
  std::string unused{};                      // the names of the kinds that were found and are not used
  TrainingExtent extent{};
};

// Sets the corrections, measures the recordings, and moves the surface out if they begin under a preload.
Status apply(CorrectedRecordings& corrected, MotionSource& source, const TrainingScene& scene, const ModelPlan& plan,
             const FitControl& control) {
  const auto measure = [&]() -> Status {
    source.correct(corrected.surfaces, corrected.surface_m);
    const auto extent = measure_extent(source, scene.jnd, control);
    if (!extent) return extent.error();
    corrected.extent = *extent;
    return {};
  };
  if (Status status = measure(); !status) return status;
  if (plan.base == Base::force) return {};
  const auto preload_m = find_preload_surface(source, corrected.extent, scene.jnd, control.at(0.05));
  if (!preload_m) return preload_m.error();
  if (*preload_m == 0.0) return {};
  corrected.surface_m += *preload_m;
  return measure();
}

TrendProblem problem_of(const MotionSource& source, const TrainingExtent& extent, const JndLine& jnd,
                        const ModelPlan& plan) {
  // Contact with a material that pulls is not one-sided: a force of 0 counts like any other.
  const double force_noise_floor_N =
      extent.lowest_force_N < 0.0 ? -std::numeric_limits<double>::infinity() : no_force_N(source.force_noise_N());
  return {extent.depth_m,
          extent.rms_velocity_m_per_s,
          force_noise_floor_N,
          plan.base == Base::force ? Weighting::jnd : plan.weights(),
          jnd,
          source.folds()};
}

// Whether any recording has this correction.
bool any_has(const std::vector<RecordingSurface>& surfaces, double RecordingSurface::*correction) {
  return std::ranges::any_of(
      surfaces, [](double value) { return value != 0.0; }, correction);
}

// The registration's corrections, without those of a kind that is not used.
CorrectedRecordings some_of(const RegisteredSurfaces& found, bool offsets, bool force_zeros, bool lag) {
  CorrectedRecordings some{found.recordings, offsets ? found.surface_position_m : found.unmoved_surface_position_m};
  const auto drop = [&](double RecordingSurface::*correction, const char* name) {
    if (!any_has(found.recordings, correction)) return;
    some.unused.append(some.unused.empty() ? "" : " and ").append(name);
    for (RecordingSurface& one : some.surfaces) {
      if (!offsets && one.offset_m != 0.0) one.standard_error_m = std::numeric_limits<double>::infinity();
      one.*correction = 0.0;
    }
  };
  if (!offsets) drop(&RecordingSurface::offset_m, "surface offsets");
  if (!force_zeros) drop(&RecordingSurface::force_zero_N, "force zeros");
  if (!lag) drop(&RecordingSurface::lag_s, "force lag");
  return some;
}

// The candidates, from the one that is preferred. A lag of the force must be significant, because viscosity and the
// memory of a material look like one; the others are preferred, because free air or overlapping positions show them.
std::vector<CorrectedRecordings> possible_corrections(const RegisteredSurfaces& found) {
  const bool lag = any_has(found.recordings, &RecordingSurface::lag_s);
  const bool offsets = any_has(found.recordings, &RecordingSurface::offset_m);
  const bool force_zeros = any_has(found.recordings, &RecordingSurface::force_zero_N);
  std::vector<CorrectedRecordings> possible;
  if (lag) possible.push_back(some_of(found, true, true, false));
  possible.push_back(some_of(found, true, true, true));
  if (offsets) possible.push_back(some_of(found, false, true, true));
  if (force_zeros || (offsets && lag)) possible.push_back(some_of(found, false, false, false));
  return possible;
}

// Corrects the recordings by their offsets, force zeros and lag as far as a trend confirms it: an effect of the
// material that the registration does not know may look like an offset. The candidates differ in the samples that are
// in contact, so the comparison is paired only by pieces of strokes.
Result<CorrectedRecordings> correct_recordings(MotionSource& source, const TrainingScene& scene, const ModelPlan& plan,
                                               std::vector<std::string>& notes, const FitControl& control) {
  source.correct({});
  std::vector<CorrectedRecordings> candidates(1);  // as recorded
  if (plan.base == Base::trend) {
    const auto found = register_surfaces(source, scene.jnd, control);
    if (!found) return found.error();
    candidates = possible_corrections(*found);
  }
  std::vector<FoldErrors> errors;
  for (CorrectedRecordings& one : candidates) {
    if (Status status = apply(one, source, scene, plan, control); !status) return status.error();
    // Without contact there is nothing to compare.
    if (candidates.size() == 1 || !(one.extent.depth_m > 0.0)) break;
    // The folds are pieces of strokes, because the question is whether one trend suits all recordings.
    source.assign_folds(one.extent.folds(1));
    auto error = simple_law_error({source, problem_of(source, one.extent, scene.jnd, plan), control.at(0.05)},
                                  dictionary(one.extent, source.sensor().encoder_step_m));
    if (!error) return error.error();
    errors.push_back(std::move(*error));
  }
  CorrectedRecordings& chosen = candidates[errors.empty() ? 0 : simplest_adequate(errors)];
  source.correct(chosen.surfaces, chosen.surface_m);
  if (!chosen.unused.empty()) {
    notes.push_back("the " + chosen.unused +
                    " found are not used: they do not lower the cross-validated error significantly");
  }
  return std::move(chosen);
}

// The scene's features with the relaxation times of the scene, of the plan, or identified ones.
Result<FeatureList> scene_list(const TrendData& data, const TrainingExtent& extent, const TrainingScene& scene,
                               const ModelPlan& plan) {
  const bool velocity = has_kind(scene.features, FeatureKind::velocity);
  const std::vector<double> times_s = relaxation_times_s(scene.features);
  const bool papers = plan.features == FeatureChoice::automatic;
  if (times_s.empty() && (papers || plan.relaxation == Relaxation::scene)) return single_times(velocity, times_s);
  if (times_s.empty()) {
    return Error{"scene \"" + scene.name +
                 "\" has no relaxation features; leave out --relaxation, or use a scene "
                 "that has them (palpate scenes)"};
  }
  if (!papers && plan.relaxation == Relaxation::scene) return single_times(velocity, times_s);
  if (!papers && plan.relaxation == Relaxation::given) return single_times(velocity, plan.relaxation_times_s);
  const auto identified = identify_relaxation(data, dictionary_times_s(extent), velocity, papers ? kPapersTimes : 0);
  if (!identified) return identified.error();
  return single_times(velocity, *identified);
}

// The gain of each part of the list: the cross-validated error with it and without it.
void add_gains(std::vector<PartGain>& gains, const TrendRows& rows, const TrendEstimator& estimator,
               const CrossValidated& with_all, const Eigen::VectorXd& x) {
  const auto& features = rows.list().features;
  for (std::size_t f = 1; f < features.size(); ++f) {  // after the depth
    const auto others = rows.columns_of([f](std::size_t other) { return other != f; });
    const bool taken = (x(rows.feature_columns()[f]).array() > 0.0).any();
    gains.push_back({term_name(features[f]), taken, with_all.errors.rms_at_mean_score(),
                     estimator.cross_validate(others).errors.rms_at_mean_score()});
  }
  std::stable_partition(gains.begin(), gains.end(), [](const PartGain& one) { return one.taken; });
}

// Trend, sites and choice of the correction of one list of features.
Status prepare_list(PreparedTraining& prepared, const TrendData& data, const FeatureList& list,
                    const TrainingExtent& extent, const TrainingScene& scene, const ModelPlan& plan) {
  ModelData& common = prepared.common;
  const bool papers = plan.base == Base::force;
  const auto rows = gather_rows(data, papers ? FeatureList{} : list, kTrendRows);
  if (!rows) return rows.error();
  const TrendEstimator estimator(*rows);
  const CrossValidated left_out = estimator.cross_validate(estimator.all_columns());
  const Eigen::VectorXd x = estimator.fit(estimator.all_columns());
  if (selects_features(plan)) add_gains(prepared.gains, *rows, estimator, left_out, x);
  const FittedTrend fitted = fitted_trend(*rows, x, !selects_features(plan));
  const std::vector<FeatureSpec>& kinds = plan.features == FeatureChoice::given ? plan.list.features : scene.features;
  common.features = papers ? with_filters(kinds, relaxation_times_s(list.features)) : fitted.features;
  if (plan.base == Base::trend) common.trend = fitted.trend;
  auto set =
      make_training_set(data.source, common.features, plan.thins(), data.problem.force_noise_floor_N, data.control);
  if (!set) return set.error();
  prepared.set = std::move(*set);
  common.largest_force_N = std::max(0.0, extent.force_N);
  common.lowest_force_N = extent.lowest_force_N;
  common.offset = prepared.set.normalisation.offset;
  common.scale = prepared.set.normalisation.scale;
  common.lower = prepared.set.normalisation.lower;
  common.upper = prepared.set.normalisation.upper;
  common.jnd = scene.jnd;
  make_sites(prepared, plan);
  if (plan.base == Base::force) return {};
  if (!data.control.may_continue()) return interrupted();
  prepared.left_out = cross_validation_rows(common, *rows, fitted.row_features, left_out.solutions);
  prepared.left_out->strokes = extent.strokes;
  prepared.left_out->kernel = prepared.sites.kernel;
  const CorrectionChoice choice = choose_correction(*prepared.left_out, common);
  prepared.correction = choice;
  prepared.sites.smoothing = choice.smoothing;
  const double outer_to_inner = common.cover.outer_radius / common.cover.inner_radius;
  common.cover.inner_radius = choice.inner_radius;
  common.cover.outer_radius = outer_to_inner * choice.inner_radius;
  return {};
}

}  // namespace

Result<PreparedTraining> prepare_training(MotionSource& source, const TrainingScene& scene, const ModelPlan& plan,
                                          const FitControl& control) {
  PreparedTraining prepared;
  auto corrected = correct_recordings(source, scene, plan, prepared.notes, control);
  if (!corrected) return corrected.error();
  const TrainingExtent& extent = corrected->extent;
  if (!control.may_continue(0.05)) return interrupted();
  if (!(extent.depth_m > 0.0)) {
    return Error{
        "no sample of the training recordings is in contact (position_m > 0): there is nothing to fit; "
        "record a press, check the sign of position_m, or set its zero (palpate import FILE --zero contact)"};
  }
  source.assign_folds(extent.folds(source.recordings().size()));
  const TrendProblem problem = problem_of(source, extent, scene.jnd, plan);
  Result<FeatureList> list = plan.list;
  if (selects_features(plan)) {
    list = select_memory_law({source, problem, control.at(0.15)}, dictionary(extent, source.sensor().encoder_step_m),
                             prepared.gains);
  } else if (plan.features != FeatureChoice::given) {
    list = scene_list({source, problem, control.at(0.1)}, extent, scene, plan);
  }
  if (!list) return list.error();
  const TrendData data{source, problem, control.at(0.2)};
  if (Status status = prepare_list(prepared, data, *list, extent, scene, plan); !status) return status.error();

  // A model takes positions in the coordinate of its recordings.
  for (FeatureSpec& spec : prepared.common.features) {
    if (spec.kind == FeatureKind::depth) spec.surface_position_m = corrected->surface_m;
  }
  prepared.common.sensor = source.sensor();
  Provenance& provenance = prepared.common.provenance;
  provenance.surfaces = std::move(corrected->surfaces);
  for (const auto& recording : source.recordings()) provenance.recordings.push_back(recording.name);
  provenance.scene = scene.name;
  provenance.samples = source.rows();
  provenance.contact_samples = prepared.set.contact_samples;
  provenance.samples_after_reduction = prepared.set.sites.size();
  provenance.weighting = kWeightingNames[static_cast<std::size_t>(plan.weights())];
  provenance.thinning = kThinningNames[static_cast<std::size_t>(plan.thins())];
  const Relaxation relaxation = plan.features == FeatureChoice::automatic ? Relaxation::automatic
                                : plan.features == FeatureChoice::given   ? Relaxation::given
                                                                          : plan.relaxation;
  provenance.relaxation = kRelaxationNames[static_cast<std::size_t>(relaxation)];
  if (!control.may_continue(0.3)) return interrupted();
  return prepared;
}

}  // namespace palpate
