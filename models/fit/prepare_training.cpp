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
// No limits for the recipe of 2009: normalised features are about 1, and an extrapolating function stays below a
// hundred times the forces of its data.
constexpr double kEverywhere = 1e6;
constexpr double kUnlimited = 100.0;

bool is_papers_recipe(const TrainingRequest& request) { return request.recipe == FitRecipe::paper_2009; }

// The paper's recipe never uses the dictionary.
bool is_automatic(const TrainingRequest& request) {
  return request.choice == FeatureChoice::automatic && !is_papers_recipe(request);
}

// The features of the recipe of 2009: the scene's, with low-passes of these times.
std::vector<FeatureSpec> with_filters(std::vector<FeatureSpec> features, const std::vector<double>& times_s) {
  std::erase_if(features, [](const FeatureSpec& spec) { return spec.kind == FeatureKind::lowpass_velocity; });
  for (const double time_s : times_s) features.push_back({FeatureKind::lowpass_velocity, time_s, {}});
  return features;
}

// The relaxation times behind the features of a model.
std::vector<RelaxationTime> times_of(const std::vector<FeatureSpec>& features) {
  std::vector<RelaxationTime> times;
  for (const FeatureSpec& spec : features) {
    if (has_time(spec.kind)) times.push_back({spec.relaxation_time_s, 0.0});
    if (!is_branch(spec.kind)) continue;
    for (const double time_s : constants_of(spec)) times.push_back({time_s, 0.0});
  }
  return times;
}

void make_sites(PreparedTraining& prepared, const TrainingRequest& request) {
  const TrainingSet& set = prepared.set;
  const auto n = static_cast<Eigen::Index>(set.sites.size());
  const std::vector<FeatureSpec>& features = prepared.common.features;
  const auto d = static_cast<Eigen::Index>(features.size());
  Sites& sites = prepared.sites;
  sites.points.resize(d, n);
  sites.target_N.resize(n);
  sites.row_scale.resize(n);
  Eigen::VectorXd base_N(n);
  for (std::size_t i = 0; i < set.sites.size(); ++i) {
    const TrainingSite& site = set.sites[i];
    const auto k = static_cast<Eigen::Index>(i);
    const Eigen::Map<const Eigen::VectorXd> x(site.features.data(), d);
    sites.points.col(k) = (x - set.normalisation.offset).cwiseQuotient(set.normalisation.scale);
    base_N(k) = prepared.common.trend.at(site.features.data(), features);
    const double residual_N = site.force_N - base_N(k);
    sites.target_N(k) = prepared.common.corrects_trend ? residual_N : site.force_N;
    // Where no force is measured and the trend is below 0, no correction is needed.
    if (site.no_force && base_N(k) < 0.0 && prepared.common.corrects_trend) sites.target_N(k) = 0.0;
    sites.row_scale(k) =
        row_scale(request.weighting, request.jnd, site.force_N) * std::sqrt(std::min(site.count, kMaximumSiteCount));
  }
  prepared.common.cover = make_cover(sites.points);
  double largest_N = 0.0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double correction_N = sites.target_N(k) - (prepared.common.corrects_trend ? 0.0 : base_N(k));
    largest_N = std::max(largest_N, std::abs(correction_N));
  }
  prepared.common.correction_limit_N = kCorrectionMargin * largest_N;
  if (!is_papers_recipe(request)) return;
  // The paper uses its function everywhere, within the limits of the output only, with even grids and with
  // pseudo-inverses by truncated singular values.
  sites.as_2009 = true;
  prepared.common.cover.inner_radius = kEverywhere;
  prepared.common.cover.outer_radius = 2.0 * kEverywhere;
  prepared.common.correction_limit_N *= kUnlimited;
}

// The recordings with the corrections of the registration that are used.
struct CorrectedRecordings {
  std::vector<RecordingSurface> surfaces;  // empty: as recorded
  double surface_m = 0.0;                  // position of the surface, in positions as recorded
  TrainingExtent extent{};
};

// Sets the corrections of the passes.
void correct(MotionSource& source, const CorrectedRecordings& corrected) {
  std::vector<RowCorrection> corrections;
  for (const RecordingSurface& one : corrected.surfaces) {
    corrections.push_back({corrected.surface_m + one.offset_m, one.force_zero_N, one.lag_s});
  }
  source.correct(std::move(corrections));
}

// Sets the corrections, measures the recordings, and moves the surface out if they begin under a preload.
Status apply(CorrectedRecordings& corrected, MotionSource& source, const TrainingRequest& request,
             const FitControl& control) {
  const auto measure = [&]() -> Status {
    correct(source, corrected);
    const auto extent = measure_extent(source, control);
    if (!extent) return extent.error();
    corrected.extent = *extent;
    return {};
  };
  if (Status status = measure(); !status) return status;
  if (request.surface == Surface::recorded) return {};
  const auto preload_m = find_preload_surface(source, corrected.extent, request.jnd, control.at(0.05));
  if (!preload_m) return preload_m.error();
  if (*preload_m == 0.0) return {};
  corrected.surface_m += *preload_m;
  return measure();
}

TrendProblem problem_of(const MotionSource& source, const TrainingExtent& extent, const TrainingRequest& request) {
  // Contact with a material that pulls is not one-sided: a force of 0 counts like any other.
  const double force_noise_floor_N =
      extent.lowest_force_N < 0.0 ? -std::numeric_limits<double>::infinity() : no_force_N(source.force_noise_N());
  return {extent.depth_m,      extent.rms_velocity_m_per_s,
          force_noise_floor_N, is_papers_recipe(request) ? Weighting::jnd : request.weighting,
          request.jnd,         source.folds()};
}

// The cross-validated error of a trend of the recordings in their present correction. Its folds are pieces of strokes,
// of three recordings or more, too, because the question is whether one trend suits all recordings.
Result<FoldErrors> error_of(MotionSource& source, const TrainingExtent& extent, const TrainingRequest& request,
                            const FitControl& control) {
  source.assign_folds(extent.folds(1));
  return simple_law_error({source, problem_of(source, extent, request), control.at(0.05)},
                          dictionary(extent, source.encoder_step_m()));
}

// Whether any recording has this correction.
bool any_has(const std::vector<RecordingSurface>& surfaces, double RecordingSurface::*correction) {
  return std::ranges::any_of(
      surfaces, [](double value) { return value != 0.0; }, correction);
}

// The registration's corrections, without those of a kind that is not used.
CorrectedRecordings some_of(const RegisteredSurfaces& found, bool offsets, bool force_zeros, bool lag) {
  CorrectedRecordings some{found.recordings, offsets ? found.surface_position_m : found.unmoved_surface_position_m};
  for (RecordingSurface& one : some.surfaces) {
    if (!offsets && one.offset_m != 0.0) one.standard_error_m = std::numeric_limits<double>::infinity();
    if (!offsets) one.offset_m = 0.0;
    if (!force_zeros) one.force_zero_N = 0.0;
    if (!lag) one.lag_s = 0.0;
  }
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

// The names of the kinds of corrections that were found and are not used; empty: all are used.
std::string unused(const RegisteredSurfaces& found, const CorrectedRecordings& chosen) {
  constexpr std::pair<double RecordingSurface::*, const char*> kKinds[] = {
      {&RecordingSurface::offset_m, "surface offsets"},
      {&RecordingSurface::force_zero_N, "force zeros"},
      {&RecordingSurface::lag_s, "force lag"}};
  std::string names;
  for (const auto& [correction, name] : kKinds) {
    if (!any_has(found.recordings, correction) || any_has(chosen.surfaces, correction)) continue;
    names.append(names.empty() ? "" : " and ").append(name);
  }
  return names;
}

// Corrects the recordings by their offsets, force zeros and lag as far as a trend confirms it: an effect of the
// material that the registration does not know may look like an offset. The candidates differ in the samples that are
// in contact, so the comparison is paired only by pieces of strokes.
Result<CorrectedRecordings> correct_recordings(MotionSource& source, const TrainingRequest& request,
                                               std::vector<std::string>& notes, const FitControl& control) {
  if (request.surface == Surface::recorded) {
    CorrectedRecordings recorded;
    if (Status status = apply(recorded, source, request, control); !status) return status.error();
    return recorded;
  }
  source.correct({});
  const auto found = register_surfaces(source, control);
  if (!found) return found.error();
  std::vector<CorrectedRecordings> candidates = possible_corrections(*found);
  std::vector<FoldErrors> errors;
  for (CorrectedRecordings& one : candidates) {
    if (Status status = apply(one, source, request, control); !status) return status.error();
    // Without contact there is nothing to compare.
    if (candidates.size() == 1 || !(one.extent.depth_m > 0.0)) break;
    auto error = error_of(source, one.extent, request, control);
    if (!error) return error.error();
    errors.push_back(std::move(*error));
  }
  CorrectedRecordings& chosen = candidates[errors.empty() ? 0 : simplest_adequate(errors)];
  correct(source, chosen);
  if (const std::string names = unused(*found, chosen); !names.empty()) {
    notes.push_back("the " + names + " found are not used: they do not lower the cross-validated error significantly");
  }
  return std::move(chosen);
}

// The scene's features with the relaxation times of the scene, of the request, or identified ones.
Result<FeatureList> scene_list(const TrendData& data, const TrainingExtent& extent, const TrainingRequest& request) {
  const bool velocity = has_kind(request.features, FeatureKind::velocity);
  std::vector<double> times_s;
  for (const FeatureSpec& spec : request.features) {
    if (has_time(spec.kind)) times_s.push_back(spec.relaxation_time_s);
  }
  if (request.relaxation != Relaxation::scene && times_s.empty()) {
    return Error{"scene \"" + request.scene +
                 "\" has no relaxation features; leave out --relaxation, or use a scene "
                 "that has them (palpate scenes)"};
  }
  if (request.relaxation == Relaxation::given) times_s = request.relaxation_times_s;
  if (request.relaxation == Relaxation::automatic) {
    auto identified = identify_relaxation(data, dictionary_times_s(extent), velocity, request.relaxation_count);
    if (!identified) return identified.error();
    times_s = std::move(*identified);
  }
  return single_times(velocity, times_s);
}

// The gain of each part of the list: the cross-validated error with it and without it.
void add_gains(std::vector<PartGain>& gains, const TrendRows& rows, const TrendRegression& regression,
               const CrossValidated& with_all, const Eigen::VectorXd& x) {
  const auto& features = rows.list().features;
  for (std::size_t f = 1; f < features.size(); ++f) {  // after the depth
    const auto others = rows.columns_of([f](std::size_t other) { return other != f; });
    const bool taken = (x(rows.feature_columns()[f]).array() > 0.0).any();
    gains.push_back({term_name(features[f]), taken, with_all.errors.rms_at_mean_score(),
                     regression.cross_validate(others).errors.rms_at_mean_score()});
  }
  std::ranges::stable_partition(gains, &PartGain::taken);
}

// Selects smoothing, strength and reach of the correction by cross-validation.
void select_strength(PreparedTraining& prepared) {
  ModelData& common = prepared.common;
  const StrengthChoice choice = choose_strength(*prepared.left_out, common);
  const double outer_to_inner = common.cover.outer_radius / common.cover.inner_radius;
  prepared.strength = choice;
  prepared.sites.smoothing = choice.smoothing;
  prepared.sites.strength = choice.strength;
  common.cover.inner_radius = choice.inner_radius;
  common.cover.outer_radius = outer_to_inner * choice.inner_radius;
}

// Trend, sites and correction strength of one list of features.
Status prepare_list(PreparedTraining& prepared, const TrendData& data, const FeatureList& list,
                    const TrainingExtent& extent, const TrainingRequest& request) {
  const bool papers = is_papers_recipe(request);
  ModelData& common = prepared.common;
  common.corrects_trend = !papers;
  const auto rows = gather_rows(data, papers ? FeatureList{} : list, kTrendRows);
  if (!rows) return rows.error();
  const TrendRegression regression(*rows);
  const CrossValidated left_out = regression.cross_validate(regression.all_columns());
  const Eigen::VectorXd x = regression.solve(regression.all_columns());
  if (is_automatic(request)) add_gains(prepared.gains, *rows, regression, left_out, x);
  const FittedTrend fitted = fitted_trend(*rows, x, !is_automatic(request));
  common.trend = fitted.trend;
  common.features = papers ? with_filters(request.features, list.relaxation_times_s()) : fitted.features;
  auto set = make_training_set(data.source, common.features, request.reduction, data.problem.force_noise_floor_N,
                               data.control);
  if (!set) return set.error();
  prepared.set = std::move(*set);
  common.largest_force_N = std::max(0.0, extent.force_N);
  common.lowest_force_N = extent.lowest_force_N;
  common.offset = prepared.set.normalisation.offset;
  common.scale = prepared.set.normalisation.scale;
  common.lower = prepared.set.normalisation.lower;
  common.upper = prepared.set.normalisation.upper;
  common.jnd = request.jnd;
  make_sites(prepared, request);
  if (papers) return {};
  prepared.left_out = cross_validation_rows(common, *rows, fitted.row_features, left_out.solutions);
  prepared.left_out->strokes = extent.strokes;
  select_strength(prepared);
  return {};
}

}  // namespace

Result<PreparedTraining> prepare_training(MotionSource& source, const TrainingRequest& request,
                                          const FitControl& control) {
  PreparedTraining prepared;
  auto corrected = correct_recordings(source, request, prepared.notes, control);
  if (!corrected) return corrected.error();
  const TrainingExtent& extent = corrected->extent;
  if (!control.may_continue(0.05)) return interrupted();
  if (!(extent.depth_m > 0.0)) {
    return Error{
        "no sample of the training recordings is in contact (position_m > 0): there is nothing to fit; "
        "record a press, check the sign of position_m, or set its zero (palpate import FILE --zero contact)"};
  }
  source.assign_folds(extent.folds(source.recordings().size()));
  const TrendProblem problem = problem_of(source, extent, request);
  Result<FeatureList> list = request.list;
  if (is_automatic(request)) {
    list = select_memory_law({source, problem, control.at(0.15)}, dictionary(extent, source.encoder_step_m()),
                             prepared.gains);
  } else if (request.choice != FeatureChoice::given) {
    list = scene_list({source, problem, control.at(0.1)}, extent, request);
  }
  if (!list) return list.error();
  const TrendData data{source, problem, control.at(0.2)};
  if (Status status = prepare_list(prepared, data, *list, extent, request); !status) return status.error();

  // A model takes positions in the coordinate of its recordings.
  for (FeatureSpec& spec : prepared.common.features) {
    if (spec.kind == FeatureKind::depth) spec.surface_position_m = corrected->surface_m;
  }
  prepared.common.sensor = SensorSpec{source.encoder_step_m(), source.position_noise_m()};
  Provenance& provenance = prepared.common.provenance;
  provenance.surfaces = std::move(corrected->surfaces);
  provenance.relaxation_times = times_of(prepared.common.features);
  for (const auto& recording : source.recordings()) provenance.recordings.push_back(recording.name);
  provenance.scene = request.scene;
  provenance.samples = source.rows();
  provenance.contact_samples = prepared.set.contact_samples;
  provenance.samples_after_reduction = prepared.set.sites.size();
  provenance.weighting = weighting_name(request.weighting);
  provenance.reduction = reduction_name(request.reduction);
  const Relaxation relaxation = request.choice == FeatureChoice::automatic ? Relaxation::automatic
                                : request.choice == FeatureChoice::given   ? Relaxation::given
                                                                           : request.relaxation;
  provenance.relaxation = kRelaxationNames[static_cast<std::size_t>(relaxation)];
  if (!control.may_continue(0.3)) return interrupted();
  return prepared;
}

}  // namespace palpate
