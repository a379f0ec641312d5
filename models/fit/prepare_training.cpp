#include <algorithm>
#include <cmath>
#include <utility>

#include "models/fit/fit.h"
#include "models/fit/fit_random.h"
#include "models/training/relaxation.h"
#include "models/training/surface_registration.h"

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
constexpr std::size_t kMaximumJudged = 100000;
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
    sites.group[i] = site.stroke;
    any_one_sided = any_one_sided || site.no_force;
  }
  if (any_one_sided && n > 1) {
    RandomOptions quick;
    quick.centres = std::min(kQuickCentres, std::max<Eigen::Index>(1, n / 4));
    for (int pass = 0; pass < kOneSidedPasses; ++pass) {
      const auto fitted = fit_random(sites, quick);
      if (!fitted) return fitted.error();
      release_one_sided(prepared, RbfEvaluator(fitted->function), base_N);
    }
  }
  double largest_N = 0.0;
  for (Eigen::Index k = 0; k < n; ++k) {
    const double correction_N = sites.target_N(k) - (prepared.common.corrects_trend ? 0.0 : base_N(k));
    largest_N = std::max(largest_N, std::abs(correction_N));
  }
  prepared.common.correction_limit_N = kCorrectionMargin * largest_N;
  return {};
}

struct Extent {
  double depth_m = 0.0;
  double force_N = 0.0;
  double rms_velocity_m_per_s = 0.0;  // in contact
};

Result<Extent> measure_extent(MotionSource& source, const FitControl& control) {
  Extent extent;
  double squares = 0.0;
  double count = 0.0;
  const Status status = source.for_each([&](const MotionRow& row) {
    if (row.sample.position_m > 0.0) {
      extent.depth_m = std::max({extent.depth_m, row.motion.position_m, 1e-9});
      extent.force_N = std::max(extent.force_N, row.force_N);
      squares += row.motion.velocity_m_per_s * row.motion.velocity_m_per_s;
      count += 1.0;
    }
    return true;
  }, control, 0.0);
  if (!status) return status.error();
  // A tool that never moved still needs a scale: 1 um/s.
  extent.rms_velocity_m_per_s = std::max(1e-6, count > 0.0 ? std::sqrt(squares / count) : 0.0);
  return extent;
}

Status fit_common_trend(PreparedTraining& prepared, MotionSource& source, const TrainingRequest& request,
                        const Extent& extent, double no_force_N, const std::vector<double>& times_s,
                        const FitControl& control) {
  const bool papers = is_papers_recipe(request);
  const bool viscous = !papers && has_velocity(request.features);
  TrendRows rows(extent.depth_m, viscous ? extent.rms_velocity_m_per_s : 0.0,
                 papers ? std::vector<double>{} : times_s);
  const Status status = source.for_each([&](const MotionRow& row) {
    if (row.first) rows.begin_recording();
    rows.add(row.sample, row.motion, row.force_N, row.stroke);
    return true;
  }, control, 0.15);
  if (!status) return status;
  FittedTrend fitted =
      fit_trend(rows, papers ? Weighting::jnd : request.weighting, request.jnd, no_force_N, request.drive);
  prepared.common.trend = fitted.trend;
  std::vector<FeatureSpec> filters = std::move(fitted.branches);
  if (papers) {
    for (const double time_s : times_s) filters.push_back({FeatureKind::lowpass_velocity, time_s, {}});
  }
  prepared.common.features = with_filters(request.features, filters);
  prepared.common.corrects_trend = !papers;
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

Status keep_judged_samples(PreparedTraining& prepared, MotionSource& source, const FitControl& control) {
  FeatureFilter filter(prepared.common.features);
  const std::size_t stride = prepared.set.contact_samples / kMaximumJudged + 1;
  std::size_t seen = 0;
  return source.for_each([&](const MotionRow& row) {
    if (row.first) filter.reset();
    const FeatureVector& vector = filter.update(row.sample, row.motion);
    if (vector.in_contact && seen++ % stride == 0) {
      prepared.judge_features.push_back(vector.values);
      prepared.judge_force_N.push_back(row.force_N);
    }
    return true;
  }, control, 0.28);
}

}  // namespace

Result<PreparedTraining> prepare_training(MotionSource& source, const TrainingRequest& request,
                                          const FitControl& control) {
  PreparedTraining prepared;
  ModelData& common = prepared.common;
  if (Status status = find_surfaces(source, request, common.provenance, control); !status) return status.error();
  const auto extent = measure_extent(source, control);
  if (!extent) return extent.error();
  if (!control.go_on(0.05)) return interrupted();
  if (!(extent->depth_m > 0.0)) {
    return Error{"no sample of the training recordings is in contact (position_m > 0): there is nothing to learn; "
                 "record a press, or check the sign and zero of position_m"};
  }
  const double no_force_N = std::max(kNoForceFloor_N, kNoForceDeviations * source.force_noise_N());

  std::vector<double> times_s = filter_times(request.features);
  if (request.relaxation != Relaxation::scene && times_s.empty()) {
    return Error{"scene \"" + request.scene + "\" has no relaxation features; leave out --relaxation, or use a scene "
                 "that has them (palpate scenes)"};
  }
  if (request.relaxation == Relaxation::given) times_s = request.relaxation_times_s;
  for (const double time_s : times_s) common.provenance.relaxation_times.push_back({time_s, 0.0});
  if (request.relaxation == Relaxation::automatic) {
    const auto identified = identify_relaxation(source, extent->depth_m,
                                                has_velocity(request.features) ? extent->rms_velocity_m_per_s : 0.0,
                                                request.weighting, request.jnd, no_force_N, control);
    if (!identified) return identified.error();
    times_s.clear();
    common.provenance.relaxation_times.clear();
    for (const IdentifiedTime& time : identified->times) {
      times_s.push_back(time.time_s);
      common.provenance.relaxation_times.push_back({time.time_s, time.standard_error_s});
    }
  }
  if (!control.go_on(0.15)) return interrupted();
  if (Status status = fit_common_trend(prepared, source, request, *extent, no_force_N, times_s, control); !status) {
    return status.error();
  }
  auto set = make_training_set(source, common.features, request.reduction, no_force_N, control, 0.2);
  if (!set) return set.error();
  prepared.set = std::move(*set);
  if (!control.go_on(0.25)) return interrupted();
  common.largest_force_N = std::max(0.0, extent->force_N);
  common.offset = prepared.set.normalisation.offset;
  common.scale = prepared.set.normalisation.scale;
  common.lower = prepared.set.normalisation.lower;
  common.upper = prepared.set.normalisation.upper;
  common.jnd = request.jnd;
  if (Status status = make_sites(prepared, request); !status) return status.error();
  common.cover = make_cover(prepared.sites.points);
  if (Status status = keep_judged_samples(prepared, source, control); !status) return status.error();

  Provenance& provenance = common.provenance;
  provenance.recordings = source.names();
  provenance.scene = request.scene;
  provenance.samples = source.rows();
  provenance.contact_samples = prepared.set.contact_samples;
  provenance.samples_after_reduction = prepared.set.sites.size();
  provenance.weighting = weighting_name(request.weighting);
  provenance.reduction = reduction_name(request.reduction);
  provenance.relaxation = kRelaxationNames[static_cast<std::size_t>(request.relaxation)];
  if (!control.go_on(0.3)) return interrupted();
  return prepared;
}

}  // namespace palpate
