#include "engine/tick/haptics_tick.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "engine/tick/jnd.h"
#include "engine/tick/motion_estimator.h"

namespace palpate {
namespace {

// The largest gap between the recalled motion and the exchange of models (a slow frame of the window, and the model
// slot). In a longer gap the motion is unknown.
constexpr double kLongestGap_s = 5.0;
// The duration of an instantaneous press: a thousandth of the shortest relaxation time of a fit.
constexpr double kInstant_s = 1e-6;

bool finite(const ToolSample& sample) noexcept {
  return std::isfinite(sample.time_s) && std::isfinite(sample.position_m) && std::isfinite(sample.velocity_m_per_s) &&
         std::isfinite(sample.acceleration_m_per_s2);
}

// Steps of MotionHistory. The filters are exact for steps of any length with a constant velocity, and that of a hand
// changes little in a step.
constexpr double kHistoryStep_s = 3.9e-3;
constexpr double kRemembered_s = 60.0;

}  // namespace

void MotionHistory::add(const TickSnapshot& snapshot, bool restarted) {
  if (restarted || (!past_.empty() && snapshot.time_s < past_.back().time_s)) past_.clear();
  if (snapshot.fault == TickFault::bad_sample || snapshot.fault == TickFault::time_not_later) return;
  if (!past_.empty() && snapshot.time_s - past_.back().time_s < kHistoryStep_s) return;
  past_.push_back({snapshot.time_s, snapshot.position_m, snapshot.velocity_m_per_s, 0.0});
  while (snapshot.time_s - past_.front().time_s > kRemembered_s) past_.pop_front();
}

void ExtremeStates::begin(const FeaturePlan& plan, const ToolSample& sample) noexcept {
  double greatest_m = 0.0;
  for (const FeatureSpec& spec : plan.specs())
    for (std::size_t p = 0; p < spec.part_count; ++p)
      greatest_m = std::max(greatest_m, spec.parts[p].drive.reference_depth_m);
  unknown = greatest_m > 0.0;
  const double surface_m = surface_position_m(plan.specs());
  states = {};
  for (std::size_t k = 0; k < states.size(); ++k) {
    ToolSample before = sample;
    before.time_s -= kInstant_s;
    before.position_m = surface_m + (k == 0 ? 0.0 : greatest_m);
    plan.update(states[k], before, {before.position_m});
  }
}

HapticsTick::HapticsTick(const SensorSpec& sensor, ForceModels models) : motion_(sensor), models_(std::move(models)) {
  assert(models_.size() <= kMaxModels);
  for (const auto& model : models_) {
    std::size_t index = 0;
    const std::vector<FeatureSpec>& specs = model->features();
    const std::vector<RecordingEnds>& ends = model->ends();
    while (index < filters_.size() && !filters_[index].plan().is_of(specs, model->deepest_m(), ends)) ++index;
    if (index == filters_.size()) filters_.emplace_back(specs, model->deepest_m(), ends);
    filter_of_.push_back(index);
  }
  extremes_.resize(filters_.size());
  snapshot_.model_count = static_cast<std::uint32_t>(models_.size());
}

void HapticsTick::reset() noexcept {
  motion_.reset();
  for (FeatureFilter& filter : filters_) filter.reset();
  for (ExtremeStates& extremes : extremes_) extremes.unknown = false;
  started_ = told_ = false;
  // Forces of the previous stream are removed.
  snapshot_ = {.tick = snapshot_.tick, .model_count = snapshot_.model_count};
}

void HapticsTick::start_after(const Recording& recording) {
  reset();
  const std::vector<RecordingRow>& rows = recording.rows;
  MotionEstimator motion(identify_sensor(rows.data(), rows.size(), recording.columns));
  for (const RecordingRow& row : rows) {
    const ToolSample sample = tool_sample(row);
    const MotionEstimate estimate = motion.update(sample);
    for (FeatureFilter& filter : filters_) {
      if (&row == &rows.front()) filter.begin(sample);
      filter.update(sample, estimate);
    }
  }
  for (FeatureFilter& filter : filters_) filter.begin_as_told();
  told_ = true;
}

void HapticsTick::rehearse() noexcept {
  if (!started_) return;
  ToolSample next = sample_;
  next.time_s += kHapticTick_s;
  MotionEstimator motion = motion_;
  const MotionEstimate estimate = motion.update(next);
  double sum_N = 0.0;
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    FeatureState state = filters_[i].state();
    filters_[i].plan().update(state, next, estimate);
    for (std::size_t k = 0; k < models_.size(); ++k)
      if (filter_of_[k] == i) sum_N += models_[k]->force(state.vector.values.data());
  }
  rehearsed_N_ = sum_N;
}

void HapticsTick::recall(const MotionHistory& history) noexcept {
  for (const ToolSample& past : history.past()) {
    for (FeatureFilter& filter : filters_) {
      if (!filter.state().started) filter.begin(past);
      filter.update(past, {past.position_m, past.velocity_m_per_s});
    }
  }
}

void HapticsTick::continue_from(const HapticsTick& before) noexcept {
  motion_ = before.motion_;
  sample_ = before.sample_;
  started_ = before.started_;
  const std::uint32_t models = snapshot_.model_count;
  snapshot_ = before.snapshot_;
  snapshot_.model_count = models;
  snapshot_.force_N.fill(0.0);
  snapshot_.predicted_error_N.fill(0.0);
  if (!started_) {
    for (FeatureFilter& filter : filters_)
      if (!told_) filter.reset();
    return;
  }
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    // The features start at rest at the last sample, unless their past is known.
    const double since_s = sample_.time_s - filters_[i].time_s();
    if (!(since_s >= 0.0 && since_s < kLongestGap_s)) filters_[i].reset();
    filters_[i].update(sample_, motion_.estimate());
    for (std::size_t k = 0; k < before.filters_.size(); ++k) {
      filters_[i].adopt(before.filters_[k]);
      if (filters_[i].plan().specs() == before.filters_[k].plan().specs()) extremes_[i] = before.extremes_[k];
    }
  }
  evaluate_models();
  assess();
}

const TickSnapshot& HapticsTick::step(const ToolSample& sample) noexcept {
  ++snapshot_.tick;
  if (!finite(sample)) {
    snapshot_.fault = TickFault::bad_sample;
    return snapshot_;
  }
  if (started_ && !(sample.time_s > sample_.time_s)) {
    snapshot_.fault = TickFault::time_not_later;
    return snapshot_;
  }
  sample_ = sample;
  const MotionEstimate motion = motion_.update(sample);
  update_features(motion);
  started_ = true;

  snapshot_.fault = TickFault::none;
  snapshot_.time_s = sample.time_s;
  snapshot_.position_m = sample.position_m;
  const bool was_in_contact = snapshot_.in_contact;
  // Each model has a surface of its own.
  snapshot_.in_contact = filters_.empty() && sample.position_m > 0.0;
  for (const FeatureFilter& one : filters_) snapshot_.in_contact = snapshot_.in_contact || one.vector().in_contact;
  snapshot_.depth_m = std::max(0.0, sample.position_m);
  snapshot_.velocity_m_per_s = motion.velocity_m_per_s;
  evaluate_models();
  if (!snapshot_.in_contact || !was_in_contact) assess();
  return snapshot_;
}

void HapticsTick::update_features(const MotionEstimate& motion) noexcept {
  for (std::size_t i = 0; i < filters_.size(); ++i) {
    const FeaturePlan& plan = filters_[i].plan();
    ExtremeStates& extremes = extremes_[i];
    const bool first = !started_ && !told_;
    if (first) filters_[i].begin(sample_);
    const bool in_contact = filters_[i].update(sample_, motion).in_contact;
    if (first && in_contact) extremes.begin(plan, sample_);
    if (!in_contact) extremes.unknown = false;
    if (!extremes.unknown) continue;
    for (FeatureState& state : extremes.states) plan.update(state, sample_, motion);
  }
}

void HapticsTick::evaluate_models() noexcept {
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const FeatureVector& vector = filters_[filter_of_[i]].vector();
    double& force_N = snapshot_.force_N[i];
    force_N = 0.0;
    if (!vector.in_contact) continue;  // the surface of a model may be deeper than that of another
    force_N = models_[i]->force(vector.values.data());
    if (std::isfinite(force_N)) continue;
    force_N = 0.0;
    snapshot_.fault = TickFault::force_not_finite;
  }
}

ForceEstimate HapticsTick::assessed(std::size_t index) const noexcept {
  if (!started_) return {};
  const ForceModel& model = *models_[index];
  const FeatureState& state = filters_[filter_of_[index]].state();
  ForceEstimate estimate{snapshot_.force_N[index]};
  if (!snapshot_.in_contact) {
    estimate.predicted_error_N = 0.0;  // in air every model returns 0 N with certainty
  } else {
    model.assess(state.vector.values.data(), estimate);
    // The unknown memory of the material.
    double unknown_N = 0.0;
    if (const ExtremeStates& extremes = extremes_[filter_of_[index]]; extremes.unknown) {
      for (const FeatureState& other : extremes.states) {
        const double other_N = model.force(other.vector.values.data());
        unknown_N = std::max(unknown_N, std::abs(other_N - estimate.force_N));
      }
    }
    estimate.predicted_error_N += unknown_N;
    estimate.out_of_domain = estimate.out_of_domain && state.vector.in_contact;
  }
  estimate.out_of_domain = estimate.out_of_domain || state.depth_m < model.shallowest_m();
  return estimate;
}

const TickSnapshot& HapticsTick::assess() noexcept {
  snapshot_.out_of_domain_mask = 0;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const ForceEstimate estimate = assessed(i);
    snapshot_.predicted_error_N[i] = estimate.predicted_error_N;
    if (estimate.out_of_domain) snapshot_.out_of_domain_mask |= 1U << i;
  }
  return snapshot_;
}

namespace {

// The least number of rows for a standard deviation.
constexpr std::size_t kFewestAirRows = 20;

// The standard deviation of the force before the first contact, due to drift of the sensor, inertia and cables. 0 with
// too few rows, and without a contact, where the force may be that of the material.
double air_deviation_N(const RecordingRow* rows, std::size_t count, double surface_m) {
  double sum = 0.0, squares = 0.0;
  std::size_t air = 0;
  for (; air < count && rows[air].position_m <= surface_m; ++air) {
    sum += rows[air].force_N;
    squares += rows[air].force_N * rows[air].force_N;
  }
  if (air < kFewestAirRows || air == count) return 0.0;
  const auto n = static_cast<double>(air);
  return std::sqrt(std::max(0.0, squares / n - (sum / n) * (sum / n)));
}

double common_surface_m(const ForceModels& models) {
  double outermost_m = std::numeric_limits<double>::infinity();
  for (const auto& model : models) {
    const double own_m = surface_position_m(model->features());
    if (own_m != 0.0) outermost_m = std::min(outermost_m, own_m);
  }
  return std::isfinite(outermost_m) ? outermost_m : 0.0;
}

}  // namespace

double least_contact_N(const RecordingRow* rows, std::size_t count, double surface_m) {
  const double noise_N = std::max(identify_force_noise_N(rows, count), air_deviation_N(rows, count, surface_m));
  return certain_force_N(noise_N);
}

RecordedContact::RecordedContact(const Recording& recording, const ForceModels& models, double surface_offset_m)
    : offset_m_(surface_offset_m),
      surface_m_(common_surface_m(models)),
      least_N_(least_contact_N(recording.rows.data(), recording.rows.size(), surface_m_ + offset_m_)) {}

ReplaySummary replay(const Recording& recording, const ForceModels& models, const ReplayVisitor& visitor,
                     double surface_offset_m, const Recording* after) {
  const std::vector<RecordingRow>& rows = recording.rows;
  ReplaySummary summary{identify_sensor(rows.data(), rows.size(), recording.columns)};
  HapticsTick tick(summary.sensor, models);
  if (after != nullptr) tick.start_after(*after);
  const RecordedContact contact(recording, models, surface_offset_m);
  for (const RecordingRow& row : rows) {
    ToolSample sample = tool_sample(row);
    sample.position_m -= surface_offset_m;
    tick.step(sample);
    TickSnapshot snapshot = tick.assess();
    snapshot.in_contact = contact.at(row);
    ++summary.samples;
    if (snapshot.in_contact) ++summary.contact_samples;
    if (visitor) visitor(row, snapshot, tick);
  }
  for (std::size_t i = 0; i < models.size(); ++i) summary.began.push_back(tick.began(i));
  return summary;
}

}  // namespace palpate
