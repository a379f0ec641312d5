#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/parallel.h"
#include "models/fit/decide_strength.h"
#include "models/fit/fit.h"
#include "models/fit/fit_random.h"
#include "models/solve/solve_weights.h"
#include "models/training/feature_list.h"
#include "models/training/relaxation.h"
#include "models/training/training_extent.h"
#include "models/surface/surface_registration.h"

namespace palpate {
namespace {

// "No measured force" is at or below three standard deviations of the force
// sensor's noise, and at least 10 mN.
constexpr double kNoForceDeviations = 3.0;
constexpr double kNoForceFloor_N = 0.01;
// A quick fit stands in for the model while one-sided samples find their side.
constexpr Eigen::Index kQuickCentres = 100;
constexpr int kOneSidedPasses = 3;
constexpr double kCorrectionMargin = 1.1;
constexpr std::size_t kMaximumEvaluationSamples = 100000;
// Where the error on strokes left out stays above these, other lists of features are
// tried beside the selected one.
constexpr double kLittleIsLeft_jnd = 0.2;
constexpr double kMuchIsLeft_jnd = 0.3;
constexpr int kLadderTimes = 6;
// As a hand moves.
constexpr double kLadderFrom_s = 0.01;
constexpr double kLadderTo_s = 3.0;
// Of the trend's regression: the noise of so many averages out.
constexpr std::size_t kTrendRows = 10000;
// A dwell of many samples counts as at most this many.
constexpr double kMaximumSiteCount = 16.0;

bool is_papers_recipe(const TrainingRequest& request) {
  return request.reduction == Reduction::force && request.weighting == Weighting::relative;
}

bool has_velocity(const std::vector<FeatureSpec>& features) {
  return std::any_of(features.begin(), features.end(),
                     [](const FeatureSpec& spec) { return spec.kind == FeatureKind::velocity; });
}

std::vector<double> filter_times(const std::vector<FeatureSpec>& features) {
  std::vector<double> times;
  for (const FeatureSpec& spec : features) {
    if (spec.kind == FeatureKind::lowpass_velocity) times.push_back(spec.relaxation_time_s);
  }
  return times;
}

// The scene's features as a list; each relaxation time is a feature.
FeatureList scene_list(const std::vector<FeatureSpec>& scene, const std::vector<double>& times_s) {
  FeatureList list;
  list.velocity = has_velocity(scene);
  for (const double time_s : times_s) list.relaxation_times_s.push_back({time_s});
  return list;
}

// The scene's features with its low-passes replaced by `filters`.
std::vector<FeatureSpec> with_filters(const std::vector<FeatureSpec>& scene, const std::vector<FeatureSpec>& filters) {
  std::vector<FeatureSpec> features;
  for (const FeatureSpec& spec : scene) {
    if (spec.kind != FeatureKind::lowpass_velocity) features.push_back(spec);
  }
  features.insert(features.end(), filters.begin(), filters.end());
  return features;
}

// Keeps the targets of one-sided sites on their side: where the model stays
// below zero the site asks for nothing.
void release_one_sided(PreparedTraining& prepared, const RbfEvaluator& model, const Eigen::VectorXd& base_N) {
  const bool corrects = prepared.common.corrects_trend;
  for (std::size_t i = 0; i < prepared.set.sites.size(); ++i) {
    if (!prepared.set.sites[i].no_force) continue;
    const auto k = static_cast<Eigen::Index>(i);
    const double correction_N = model.evaluate(prepared.sites.points.col(k).data());
    const double predicted_N = correction_N + (corrects ? base_N(k) : 0.0);
    const double measured_N = prepared.set.sites[i].force_N - (corrects ? base_N(k) : 0.0);
    prepared.sites.target_N(k) = predicted_N < 0.0 ? correction_N : measured_N;
  }
}

// The centres of the quick fit stay, and so they are chosen once.
Status find_sides(PreparedTraining& prepared, const Eigen::VectorXd& base_N) {
  const Eigen::Index n = prepared.sites.count();
  RandomOptions quick;
  quick.centres = std::min(kQuickCentres, std::max<Eigen::Index>(1, n / 4));
  const auto sequence = choose_random(prepared.sites, quick);
  if (!sequence) return sequence.error();
  RepeatedSolve quick_fit(prepared.sites, quick.kernel, sequence->centres_of(sequence->most));
  for (int pass = 0; pass < kOneSidedPasses; ++pass) {
    const auto fitted = quick_fit.solve();
    if (!fitted) return fitted.error();
    release_one_sided(prepared, RbfEvaluator(fitted->function), base_N);
  }
  return {};
}

Status make_sites(PreparedTraining& prepared, const TrainingRequest& request) {
  const TrainingSet& set = prepared.set;
  const auto n = static_cast<Eigen::Index>(set.sites.size());
  const auto d = static_cast<Eigen::Index>(set.features.size());
  Sites& sites = prepared.sites;
  sites.points.resize(d, n);
  sites.target_N.resize(n);
  sites.row_scale.resize(n);
  sites.group.resize(set.sites.size());
  Eigen::VectorXd base_N(n);
  bool any_one_sided = false;
  for (std::size_t i = 0; i < set.sites.size(); ++i) {
    const TrainingSite& site = set.sites[i];
    const auto k = static_cast<Eigen::Index>(i);
    const Eigen::Map<const Eigen::VectorXd> x(site.features.data(), d);
    sites.points.col(k) = (x - set.normalisation.offset).cwiseQuotient(set.normalisation.scale);
    base_N(k) = prepared.common.trend.at(site.features.data(), set.features);
    const double residual_N = site.force_N - base_N(k);
    sites.target_N(k) = prepared.common.corrects_trend ? residual_N : site.force_N;
    if (site.no_force && base_N(k) < 0.0 && prepared.common.corrects_trend) sites.target_N(k) = 0.0;
    sites.row_scale(k) = row_scale(request.weighting, request.jnd, site.force_N) *
                         std::sqrt(std::min(site.count, kMaximumSiteCount));
    sites.group[i] = prepared.strength ? site.fold : site.stroke;
    any_one_sided = any_one_sided || site.no_force;
  }
  Status sides;
  parallel_for(2, [&](int part) {
    if (part == 0 && any_one_sided && n > 1) sides = find_sides(prepared, base_N);
    if (part == 1) prepared.common.cover = make_cover(sites.points);
  });
  if (!sides) return sides;
  double largest_N = 0.0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double correction_N = sites.target_N(k) - (prepared.common.corrects_trend ? 0.0 : base_N(k));
    largest_N = std::max(largest_N, std::abs(correction_N));
  }
  prepared.common.correction_limit_N = kCorrectionMargin * largest_N;
  return {};
}

Status fit_common_trend(PreparedTraining& prepared, MotionSource& source, const TrainingRequest& request,
                        const TrainingExtent& extent, double force_noise_floor_N, const FeatureList& list, const FitControl& control) {
  const bool papers = is_papers_recipe(request);
  TrendTerms terms{extent.depth_m, 0.0, {}, {}, {}};
  if (!papers) terms = terms_of(list, extent.depth_m, extent.rms_velocity_m_per_s);
  TrendRows rows(terms, kTrendRows);
  const Status status = source.for_each([&](const MotionRow& row) {
    if (row.first) rows.begin_recording();
    if (row.run_up) rows.advance(row.sample, row.motion);
    else rows.add(row.sample, row.motion, row.force_N, row.stroke);
    return true;
  }, control, 0.15);
  if (!status) return status;
  const FittedTrend fitted =
      fit_trend(rows, papers ? Weighting::jnd : request.weighting, request.jnd, force_noise_floor_N, request.drive,
                !papers);
  prepared.common.trend = fitted.trend;
  prepared.common.corrects_trend = !papers;
  if (!papers) {
    prepared.common.features = features_of(list, fitted);
    return {};
  }
  std::vector<FeatureSpec> filters;
  for (const double time_s : all_times(list)) filters.push_back({FeatureKind::lowpass_velocity, time_s, {}});
  prepared.common.features = with_filters(request.features, filters);
  return {};
}

// Moves every recording to its own surface.
Status find_surfaces(MotionSource& source, const TrainingRequest& request, Provenance& provenance,
                     const FitControl& control) {
  source.correct({});
  if (request.surface == Surface::recorded) return {};
  const auto surfaces = register_surfaces(source, request.features, control);
  if (!surfaces) return surfaces.error();
  source.correct(corrections_of(*surfaces));
  for (std::size_t i = 0; i < surfaces->size(); ++i) {
    const RegisteredSurface& one = (*surfaces)[i];
    provenance.surfaces.push_back({source.names()[i], one.offset_m, one.standard_error_m, one.force_zero_N});
  }
  return {};
}

// Positions of a model are those of its recordings: a surface that all of them have
// deeper than 0 is the model's own place of contact, and a recording of the same rig
// needs no moving. (A surface above 0 cannot be: the tool is in contact beyond 0 at the
// latest, so such recordings are moved to it.)
void keep_position_zero(ModelData& common) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const RecordingSurface& one : common.provenance.surfaces) least_m = std::min(least_m, one.offset_m);
  if (!(least_m > 0.0) || !std::isfinite(least_m)) return;
  for (FeatureSpec& spec : common.features) {
    if (spec.kind == FeatureKind::depth) spec.surface_position_m = least_m;
  }
}

// Keeps samples to evaluate the fit with, of as many in contact as there will be.
class EvaluationSamples {
 public:
  EvaluationSamples(PreparedTraining& prepared, const FoldDealer& dealer, std::size_t contact_samples)
      : prepared_(prepared), folds_(dealer), stride_(contact_samples / kMaximumEvaluationSamples + 1) {}

  void add(const MotionRow& row, const FeatureVector& vector) {
    const int fold = folds_.next(row);
    if (seen_++ % stride_ != 0) return;
    prepared_.evaluation_features.push_back(vector.values);
    prepared_.evaluation_force_N.push_back(row.force_N);
    prepared_.evaluation_fold.push_back(fold);
  }

 private:
  PreparedTraining& prepared_;
  FoldDealer folds_;
  std::size_t stride_;
  std::size_t seen_ = 0;
};

// The relaxation times of the scene, given ones instead, or identified ones.
Result<std::vector<double>> scene_times(MotionSource& source, const TrainingRequest& request, const TrainingExtent& extent,
                                        double force_noise_floor_N, Provenance& provenance, const FitControl& control) {
  std::vector<double> times_s = filter_times(request.features);
  if (request.relaxation != Relaxation::scene && times_s.empty()) {
    return Error{"scene \"" + request.scene + "\" has no relaxation features; leave out --relaxation, or use a scene "
                 "that has them (palpate scenes)"};
  }
  if (request.relaxation == Relaxation::given) times_s = request.relaxation_times_s;
  if (request.relaxation != Relaxation::automatic) {
    for (const double time_s : times_s) provenance.relaxation_times.push_back({time_s, 0.0});
    return times_s;
  }
  const auto identified = identify_relaxation(source, extent.depth_m,
                                              has_velocity(request.features) ? extent.rms_velocity_m_per_s : 0.0,
                                              request.weighting, request.jnd, force_noise_floor_N, control);
  if (!identified) return identified.error();
  times_s.clear();
  for (const IdentifiedTime& time : identified->times) {
    times_s.push_back(time.time_s);
    provenance.relaxation_times.push_back({time.time_s, time.standard_error_s});
  }
  return times_s;
}

// What all candidate lists of features share.
struct Ground {
  MotionSource& source;
  DecisionRows& decisions;
  const TrainingRequest& request;
  const TrainingExtent& extent;
  const FoldDealer& dealer;  // of the source
  double force_noise_floor_N;
};

// Trend, sites and correction strength of one list of features.
Status prepare_list(PreparedTraining& prepared, const Ground& ground, const FeatureList& list,
                    const FitControl& control) {
  const TrainingRequest& request = ground.request;
  ModelData& common = prepared.common;
  if (Status status = fit_common_trend(prepared, ground.decisions.rows(), request, ground.extent,
                                       ground.force_noise_floor_N, list, control);
      !status) {
    return status;
  }
  const bool papers = is_papers_recipe(request);
  EvaluationSamples evaluation(prepared, ground.dealer, ground.extent.contact_samples);
  TrainingSetOptions options{0.2, papers ? nullptr : &ground.dealer, ground.decisions.sample(), {}};
  options.also = [&](const MotionRow& row, const FeatureVector& vector) { evaluation.add(row, vector); };
  auto set = make_training_set(ground.source, common.features, request.reduction, ground.force_noise_floor_N, control, options);
  if (!set) return set.error();
  prepared.set = std::move(*set);
  if (!control.may_continue(0.25)) return interrupted();
  common.largest_force_N = std::max(0.0, ground.extent.force_N);
  common.offset = prepared.set.normalisation.offset;
  common.scale = prepared.set.normalisation.scale;
  common.lower = prepared.set.normalisation.lower;
  common.upper = prepared.set.normalisation.upper;
  common.jnd = request.jnd;
  if (!papers) prepared.strength.emplace();
  if (Status status = make_sites(prepared, request); !status) return status;
  if (!papers) decide_strength(prepared, request.jnd, ground.dealer.folds(), ground.extent.strokes);
  return {};
}

// Lists that the selected one must not lose against: the scene's own, and, where much
// is left to explain, six times on a logarithmic ladder, each a feature.
std::vector<FeatureList> rivals_of(const FeatureSelection& selection, const TrainingRequest& request,
                                   double left_over_jnd) {
  std::vector<FeatureList> rivals;
  const auto add = [&](FeatureList rival) {
    rival.slowing = selection.list.slowing;
    rival.spline_elastic = selection.list.spline_elastic;
    rival.spline_branches = selection.list.spline_branches;
    rival.surface = selection.list.surface;
    rivals.push_back(std::move(rival));
  };
  if (selection.turns_round && left_over_jnd > kLittleIsLeft_jnd) {
    add(scene_list(request.features, filter_times(request.features)));
  }
  if (selection.turns_round && left_over_jnd > kMuchIsLeft_jnd) {
    FeatureList ladder;
    ladder.velocity = selection.list.surface.empty();  // eight features in all
    const double shortest_s = std::max(kLadderFrom_s, selection.shortest_s);
    const double longest_s = std::min(kLadderTo_s, selection.longest_s);
    for (int i = 0; i < kLadderTimes; ++i) {
      const double share = static_cast<double>(i) / (kLadderTimes - 1);
      ladder.relaxation_times_s.push_back({shortest_s * std::pow(longest_s / shortest_s, share)});
    }
    add(std::move(ladder));
  }
  return rivals;
}

// Features as the recordings have it; `prepared` brings its provenance.
Result<PreparedTraining> prepare_automatic(const PreparedTraining& begun, const Ground& ground,
                                           const FitControl& control) {
  const TrainingRequest& request = ground.request;
  const SelectionInput input{ground.extent.depth_m,       ground.extent.rms_velocity_m_per_s, ground.force_noise_floor_N,
                             ground.extent.turns_round(), request.weighting,                  request.jnd};
  auto selection = select_features(ground.decisions.rows(), ground.decisions.dealer(), input, control, 0.1);
  if (!selection) return selection.error();
  const auto prepare = [&](const FeatureList& list) -> Result<PreparedTraining> {
    PreparedTraining prepared = begun;
    prepared.selection = *selection;
    for (const double time_s : all_times(list)) prepared.common.provenance.relaxation_times.push_back({time_s, 0.0});
    if (Status status = prepare_list(prepared, ground, list, control); !status) return status.error();
    return prepared;
  };
  auto best = prepare(selection->list);
  if (!best) return best.error();
  for (const FeatureList& rival : rivals_of(*selection, request, best->strength->error_over_jnd)) {
    auto other = prepare(rival);
    if (!other) return other.error();
    if (is_better(*other->strength, *best->strength)) best = std::move(other);
  }
  return best;
}

}  // namespace

Result<PreparedTraining> prepare_training(MotionSource& source, const TrainingRequest& request,
                                          const FitControl& control) {
  PreparedTraining prepared;
  if (Status status = find_surfaces(source, request, prepared.common.provenance, control); !status) {
    return status.error();
  }
  const auto extent = measure_extent(source, control);
  if (!extent) return extent.error();
  if (!control.may_continue(0.05)) return interrupted();
  if (!(extent->depth_m > 0.0)) {
    return Error{"no sample of the training recordings is in contact (position_m > 0): there is nothing to learn; "
                 "record a press, or check the sign and zero of position_m"};
  }
  const double force_noise_floor_N = std::max(kNoForceFloor_N, kNoForceDeviations * source.force_noise_N());
  const FoldDealer dealer = dealer_for(source, *extent);
  auto decisions = DecisionRows::of(source, *extent, control);
  if (!decisions) return decisions.error();
  const Ground ground{source, *decisions, request, *extent, dealer, force_noise_floor_N};
  if (request.choice == FeatureChoice::automatic) {
    auto automatic = prepare_automatic(prepared, ground, control);
    if (!automatic) return automatic.error();
    prepared = std::move(*automatic);
  } else {
    FeatureList list = request.list;
    if (request.choice == FeatureChoice::scene) {
      const auto times_s = scene_times(source, request, *extent, force_noise_floor_N, prepared.common.provenance, control);
      if (!times_s) return times_s.error();
      list = scene_list(request.features, *times_s);
    } else {
      for (const double time_s : all_times(list)) prepared.common.provenance.relaxation_times.push_back({time_s, 0.0});
    }
    if (!control.may_continue(0.15)) return interrupted();
    if (Status status = prepare_list(prepared, ground, list, control); !status) return status.error();
  }

  keep_position_zero(prepared.common);
  prepared.common.sensor = PositionSensor{source.encoder_step_m(), source.position_noise_m()};
  Provenance& provenance = prepared.common.provenance;
  provenance.recordings = source.names();
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
