#include <algorithm>
#include <cmath>
#include <iterator>
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

bool has_velocity(const std::vector<FeatureSpec>& features) {
  return std::any_of(features.begin(), features.end(),
                     [](const FeatureSpec& spec) { return spec.kind == FeatureKind::velocity; });
}

// The scene's features as a list; each relaxation time is a feature.
FeatureList scene_list(const std::vector<FeatureSpec>& scene, const std::vector<double>& times_s) {
  FeatureList list;
  list.velocity = has_velocity(scene);
  for (const double time_s : times_s) list.relaxation_times_s.push_back({time_s});
  return list;
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
    for (std::size_t p = 0; spec.kind == FeatureKind::maxwell_spectrum && p < spec.part_count; ++p) {
      times.push_back({spec.parts[p].relaxation_time_s, 0.0});
    }
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

// The recordings with one set of corrections.
struct CorrectedRecordings {
  std::vector<RowCorrection> corrections;
  double surface_m = 0.0;  // position of the surface, in positions as recorded
  TrainingExtent extent{};
  // The corrections of the registration that are used.
  bool offsets = true;
  bool force_zeros = true;
  bool lag = true;
};

// Applies the corrections and measures the recordings.
Status apply(CorrectedRecordings& corrected, MotionSource& source, const TrainingRequest& request,
             const FitControl& control) {
  source.correct(corrected.corrections);
  auto extent = measure_extent(source, control);
  if (!extent) return extent.error();
  corrected.extent = *extent;
  if (request.surface == Surface::recorded) return {};
  const auto beginning_m = find_preload_surface(source, *extent, request.jnd, control);
  if (!beginning_m) return beginning_m.error();
  if (*beginning_m == 0.0) return {};
  for (RowCorrection& one : corrected.corrections) one.offset_m += *beginning_m;
  corrected.surface_m += *beginning_m;
  source.correct(corrected.corrections);
  extent = measure_extent(source, control);
  if (!extent) return extent.error();
  corrected.extent = *extent;
  return {};
}

TrendProblem problem_of(const MotionSource& source, const TrainingExtent& extent, const TrainingRequest& request) {
  // Contact with a material that pulls is not one-sided: a force of 0 counts like any other.
  const double force_noise_floor_N =
      extent.lowest_force_N < 0.0 ? -std::numeric_limits<double>::infinity() : no_force_N(source.force_noise_N());
  return {extent.depth_m,      extent.rms_velocity_m_per_s,
          force_noise_floor_N, is_papers_recipe(request) ? Weighting::jnd : request.weighting,
          request.jnd,         source.folds()};
}

FeatureList dictionary_of(const MotionSource& source, const TrainingExtent& extent) {
  return dictionary(extent.sample_s, extent.longest_recording_s, extent.depth_m, source.encoder_step_m());
}

// The cross-validated error of a trend of the recordings in their present correction. Its folds are pieces of strokes,
// of three recordings or more, too, because the question is whether one trend suits all recordings.
Result<FoldErrors> error_of(MotionSource& source, const TrainingExtent& extent, const TrainingRequest& request,
                            const FitControl& control) {
  source.assign_folds({1, extent.strokes, extent.contact_samples, extent.has_unloading()});
  return simple_law_error(source, dictionary_of(source, extent), problem_of(source, extent, request), control, 0.05);
}

// The registration's corrections, without those of a kind that is not used.
CorrectedRecordings some_of(const RegisteredSurfaces& found, bool offsets, bool force_zeros, bool lag) {
  CorrectedRecordings some;
  some.offsets = offsets;
  some.force_zeros = force_zeros;
  some.lag = lag;
  some.surface_m = offsets ? found.surface_position_m : found.unmoved_surface_position_m;
  for (const RecordingSurface& one : found.recordings) {
    some.corrections.push_back(
        {some.surface_m + (offsets ? one.offset_m : 0.0), force_zeros ? one.force_zero_N : 0.0, lag ? one.lag_s : 0.0});
  }
  return some;
}

// The candidates, from the one that is preferred. A lag of the force must be significant, because viscosity and the
// memory of a material look like one; the others are preferred, because free air or overlapping positions show them.
std::vector<CorrectedRecordings> possible_corrections(const RegisteredSurfaces& found) {
  const auto any = [&](double RecordingSurface::*correction) {
    return std::ranges::any_of(found.recordings, [&](const RecordingSurface& one) { return one.*correction != 0.0; });
  };
  const bool lag = any(&RecordingSurface::lag_s);
  const bool offsets = any(&RecordingSurface::offset_m);
  const bool force_zeros = any(&RecordingSurface::force_zero_N);
  std::vector<CorrectedRecordings> possible;
  if (lag) possible.push_back(some_of(found, true, true, false));
  possible.push_back(some_of(found, true, true, true));
  if (offsets) possible.push_back(some_of(found, false, true, true));
  if (force_zeros || (offsets && lag)) possible.push_back(some_of(found, false, false, false));
  return possible;
}

// The names of the kinds of corrections that were found and are not used; empty: all are used.
std::string unused(const RegisteredSurfaces& found, const CorrectedRecordings& chosen) {
  std::string names;
  const auto add = [&](bool used, double RecordingSurface::*correction, const char* name) {
    const auto& all = found.recordings;
    if (used || std::ranges::all_of(all, [&](const RecordingSurface& one) { return one.*correction == 0.0; })) return;
    names.append(names.empty() ? "" : " and ").append(name);
  };
  add(chosen.offsets, &RecordingSurface::offset_m, "surface offsets");
  add(chosen.force_zeros, &RecordingSurface::force_zero_N, "force zeros");
  add(chosen.lag, &RecordingSurface::lag_s, "force lag");
  return names;
}

// Corrects the recordings by their offsets, force zeros and lag as far as a trend confirms it: an effect of the
// material that the registration does not know may look like an offset. The candidates differ in the samples that are
// in contact, so the comparison is paired only by pieces of strokes.
Result<CorrectedRecordings> correct_recordings(MotionSource& source, const TrainingRequest& request,
                                               PreparedTraining& prepared, const FitControl& control) {
  if (request.surface == Surface::recorded) {
    CorrectedRecordings recorded;
    if (Status status = apply(recorded, source, request, control); !status) return status.error();
    return recorded;
  }
  source.correct({});
  auto found = register_surfaces(source, request.jnd, control);
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
  source.correct(chosen.corrections);
  if (const std::string names = unused(*found, chosen); !names.empty()) {
    prepared.notes.push_back("the " + names +
                             " found are not used: they do not lower the cross-validated error significantly");
  }
  for (RecordingSurface& one : found->recordings) {
    if (!chosen.offsets && one.offset_m != 0.0) one.standard_error_m = std::numeric_limits<double>::infinity();
    if (!chosen.offsets) one.offset_m = 0.0;
    if (!chosen.force_zeros) one.force_zero_N = 0.0;
    if (!chosen.lag) one.lag_s = 0.0;
  }
  prepared.common.provenance.surfaces = std::move(found->recordings);
  return std::move(chosen);
}

// The data that all lists of features share.
struct Given {
  MotionSource& source;
  const TrainingRequest& request;
  const TrainingExtent& extent;
  const TrendProblem& problem;
};

// The relaxation times: those of the scene, of the request, or identified ones.
Result<std::vector<double>> scene_times(const Given& given, Provenance& provenance, const FitControl& control) {
  const TrainingRequest& request = given.request;
  std::vector<double> times_s;
  for (const FeatureSpec& spec : request.features) {
    if (spec.kind == FeatureKind::lowpass_velocity) times_s.push_back(spec.relaxation_time_s);
  }
  if (request.relaxation != Relaxation::scene && times_s.empty()) {
    return Error{"scene \"" + request.scene +
                 "\" has no relaxation features; leave out --relaxation, or use a scene "
                 "that has them (palpate scenes)"};
  }
  if (request.relaxation == Relaxation::given) times_s = request.relaxation_times_s;
  if (request.relaxation == Relaxation::automatic) {
    auto identified = identify_relaxation(given.source, given.problem, given.extent, has_velocity(request.features),
                                          request.relaxation_count, control, 0.1);
    if (!identified) return identified.error();
    times_s = std::move(*identified);
  }
  for (const double time_s : times_s) provenance.relaxation_times.push_back({time_s, 0.0});
  return times_s;
}

// All candidate terms, with the law of memory selected from the recordings.
Result<FeatureList> automatic_list(PreparedTraining& prepared, const Given& given, const FitControl& control) {
  return select_memory_law(given.source, dictionary_of(given.source, given.extent), given.problem, prepared.gains,
                           control, 0.15);
}

// The gain of each part of the list: the cross-validated error with it and without it.
void add_gains(PreparedTraining& prepared, const TrendRows& rows, const TrendRegression& regression,
               const CrossValidated& with_all, const Eigen::VectorXd& x) {
  for (const FeatureColumns& group : feature_columns(rows)) {
    ColumnList others;
    std::ranges::set_difference(regression.all_columns(), group.columns, std::back_inserter(others));
    const bool taken = (x(group.columns).array() > 0.0).any();
    prepared.gains.push_back({group.name, taken, with_all.errors.rms_at_mean_score(),
                              regression.cross_validate(others).errors.rms_at_mean_score()});
  }
  std::stable_partition(prepared.gains.begin(), prepared.gains.end(), [](const PartGain& one) { return one.taken; });
}

// Selects smoothing, strength and reach of the correction by cross-validation.
void select_strength(PreparedTraining& prepared) {
  ModelData& common = prepared.common;
  const StrengthChoice choice = choose_strength(*prepared.left_out, common);
  const double outer_to_inner = common.cover.outer_radius / common.cover.inner_radius;
  prepared.strength = choice;
  prepared.sites.smoothing = choice.smoothing;
  prepared.sites.target_N *= choice.strength;
  common.cover.inner_radius = choice.inner_radius;
  common.cover.outer_radius = outer_to_inner * choice.inner_radius;
}

// Trend, sites and correction strength of one list of features.
Status prepare_list(PreparedTraining& prepared, const Given& given, const FeatureList& list,
                    const FitControl& control) {
  const TrainingRequest& request = given.request;
  const bool papers = is_papers_recipe(request);
  const bool automatic = is_automatic(request);
  ModelData& common = prepared.common;
  common.corrects_trend = !papers;
  const auto rows =
      gather_rows(given.source, papers ? FeatureList{} : list, given.problem, kTrendRows, 0.0, control, 0.2);
  if (!rows) return rows.error();
  const TrendRegression regression(*rows);
  const CrossValidated left_out = regression.cross_validate(regression.all_columns());
  const Eigen::VectorXd x = regression.solve(regression.all_columns());
  if (automatic) add_gains(prepared, *rows, regression, left_out, x);
  const FittedTrend fitted = fitted_trend(*rows, x, !automatic);
  common.trend = fitted.trend;
  common.features = papers ? with_filters(request.features, list.all_times_s()) : fitted.features;
  auto set =
      make_training_set(given.source, common.features, request.reduction, given.problem.force_noise_floor_N, control);
  if (!set) return set.error();
  prepared.set = std::move(*set);
  if (!control.may_continue(0.3)) return interrupted();
  common.largest_force_N = std::max(0.0, given.extent.force_N);
  common.lowest_force_N = given.extent.lowest_force_N;
  common.offset = prepared.set.normalisation.offset;
  common.scale = prepared.set.normalisation.scale;
  common.lower = prepared.set.normalisation.lower;
  common.upper = prepared.set.normalisation.upper;
  common.jnd = request.jnd;
  make_sites(prepared, request);
  if (papers) return {};
  prepared.left_out = cross_validation_rows(common, *rows, fitted.row_features, left_out.solutions);
  prepared.strokes = given.extent.strokes;
  select_strength(prepared);
  return {};
}

}  // namespace

Result<PreparedTraining> prepare_training(MotionSource& source, const TrainingRequest& request,
                                          const FitControl& control) {
  PreparedTraining prepared;
  const auto corrected = correct_recordings(source, request, prepared, control);
  if (!corrected) return corrected.error();
  const TrainingExtent& extent = corrected->extent;
  if (!control.may_continue(0.05)) return interrupted();
  if (!(extent.depth_m > 0.0)) {
    return Error{
        "no sample of the training recordings is in contact (position_m > 0): there is nothing to fit; "
        "record a press, check the sign of position_m, or set its zero (palpate import FILE --zero contact)"};
  }
  source.assign_folds(fold_assignment_for(source, extent));
  const TrendProblem problem = problem_of(source, extent, request);
  const Given given{source, request, extent, problem};
  FeatureList list = request.list;
  if (is_automatic(request)) {
    auto found = automatic_list(prepared, given, control);
    if (!found) return found.error();
    list = std::move(*found);
  } else if (request.choice != FeatureChoice::given) {
    const auto times_s = scene_times(given, prepared.common.provenance, control);
    if (!times_s) return times_s.error();
    list = scene_list(request.features, *times_s);
  }
  if (Status status = prepare_list(prepared, given, list, control); !status) return status.error();

  // A model takes positions in the coordinate of its recordings.
  for (FeatureSpec& spec : prepared.common.features) {
    if (spec.kind == FeatureKind::depth) spec.surface_position_m = corrected->surface_m;
  }
  prepared.common.sensor = SensorSpec{source.encoder_step_m(), source.position_noise_m()};
  Provenance& provenance = prepared.common.provenance;
  if (is_automatic(request) || request.choice == FeatureChoice::given) {
    provenance.relaxation_times = times_of(prepared.common.features);
  }
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
