#include "scenes/live/comparison.h"

#include "models/trend/trend_estimator.h"

namespace palpate {

// A longer gap between two snapshots is a stall; only this part of it counts as time.
constexpr double kLongestStep_s = 0.1;
// A stream that begins this soon after the recording's first sample is settled: one tick may take several samples.
constexpr double kBeginning_s = 0.05;
// After 5 time constants a first-order filter has less than 1 % of its initial error.
constexpr double kSettled_memories = 5.0;

void StreamErrors::add(double model_N, double reference_N, const JndLine& jnd) {
  figures_.add(model_N, reference_N, false, jnd);
  const double bin = kPerOctave * std::log2(std::max(jnd.error_over_jnd(model_N, reference_N), 1e-9)) + kBelow;
  ++counts_[static_cast<std::size_t>(std::clamp(std::ceil(bin - 1e-9), 0.0, kBins - 1.0))];
}

ErrorSummary StreamErrors::summary(const JndLine& jnd) const {
  ErrorSummary summary = figures_.summary(jnd);
  std::uint64_t beyond = summary.samples / 100;  // number of samples that may lie above
  std::size_t bin = counts_.size() - 1;
  for (; bin > 0 && counts_[bin] <= beyond; --bin) beyond -= counts_[bin];
  summary.p99_error_over_jnd = bin > 0 ? std::exp2((static_cast<double>(bin) - kBelow) / kPerOctave) : 0.0;
  return summary;
}

double SustainedError::add(double time_s, double difference_over_jnd) {
  constexpr std::size_t kMost = 1000;  // 50 ms at 20 kHz, the fastest recording
  if (!samples_.empty() && (time_s < samples_.back().first || time_s - samples_.back().first > kSpan_s))
    samples_.clear();
  while (!samples_.empty() && (samples_.front().first <= time_s - kSpan_s || samples_.size() == kMost)) {
    sum_ -= samples_.front().second;
    samples_.pop_front();
  }
  if (samples_.empty()) sum_ = 0.0;  // discards accumulated rounding errors
  samples_.emplace_back(time_s, difference_over_jnd);
  sum_ += difference_over_jnd;
  return sum_ / static_cast<double>(samples_.size());
}

void NoticedErrors::add(HistoryPoint& point, const JndLine& jnd) {
  constexpr double kPause_s = 0.2;
  const bool new_press = point.in_contact && !(std::abs(point.time_s - last_contact_s_) < kPause_s);
  if (point.in_contact) last_contact_s_ = point.time_s;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    Slot& slot = slots_[i];
    const double difference = point.difference_over_jnd(i, jnd);
    slot.sustained_over_jnd = slot.error.add(point.time_s, std::isnan(difference) ? 0.0 : difference);
    if (new_press) slot.press_over_jnd = 0.0;
    if (std::isnan(difference)) continue;
    if (point.in_contact) slot.press_over_jnd = std::max(slot.press_over_jnd, std::abs(slot.sustained_over_jnd));
    point.sustained_over_jnd[i] = static_cast<float>(slot.sustained_over_jnd);
    point.press_over_jnd[i] = static_cast<float>(slot.press_over_jnd);
  }
}

Dent::Dent(const std::vector<FeatureSpec>& features) {
  for (const double time_s : relaxation_times_s(features)) branches_.push_back({time_s, 0.0});
}

void Dent::step(double depth_m, double force_N, double error_over_jnd, double step_s) {
  constexpr double kFading_s = 0.3;
  double sum_m = 0.0;
  for (Branch& branch : branches_) {
    branch.depth_m = force_N > 0.0 ? depth_m : branch.depth_m * std::exp(-step_s / branch.relaxation_time_s);
    sum_m += branch.depth_m;
  }
  const double mean_m = branches_.empty() ? 0.0 : sum_m / static_cast<double>(branches_.size());
  dent_m_ = std::max(depth_m, mean_m);
  error_over_jnd_ = std::max(error_over_jnd, error_over_jnd_ * std::exp(-step_s / kFading_s));
}

Comparison::Comparison(const SessionModels& models, ReferenceKind reference, const JndLine& jnd)
    : models_(models), jnd_(jnd), reference_(reference) {}

void Comparison::forget_errors() {
  counted_s_ = 0.0;
  for (Slot& slot : slots_) slot.errors = {};
}

void Comparison::begin_slot(std::size_t slot) { slots_[slot].dent = Dent(models_.model(slot)->features()); }

void Comparison::forget_slot(std::size_t slot) {
  slots_[slot] = {};
  noticed_.forget(slot);
  history_.forget(slot);
}

ModelFigures Comparison::figures(std::size_t slot) const {
  const Slot& one = slots_[slot];
  ModelFigures figures;
  figures.errors = one.errors.summary(jnd_);
  figures.dent_m = one.dent.depth_m();
  figures.recent_error_over_jnd = one.dent.error_over_jnd();
  return figures;
}

void Comparison::add(const LoopSnapshot& snapshot, TickFaultLevel fault_level) {
  const PublishedSet* set = models_.set_of(snapshot);
  const double step_s = std::clamp(snapshot.loop_time_s - last_loop_time_s_, 0.0, kLongestStep_s);
  last_loop_time_s_ = snapshot.loop_time_s;
  const double time_s = snapshot.tick.time_s;
  // Models that join in a stream are initialised with its motion from its first sample on (HapticsTick::recall).
  if (snapshot.restarted) settled_ = time_s < begins_at_s_ + kBeginning_s;
  if (snapshot.restarted || (set == nullptr && !settled_)) stream_began_s_ = last_time_s_ = time_s;
  if (set != nullptr &&
      (!snapshot.tick.in_contact || time_s > stream_began_s_ + kSettled_memories * models_.longest_memory_s()))
    settled_ = true;
  HistoryPoint point = point_of(snapshot, set);
  point.fault_level = fault_level_ = std::max(fault_level_, fault_level);
  // While a replay is paused, ticks have no new sample.
  const bool fresh = snapshot.samples > 0;
  if (fresh && set != nullptr) {
    noticed_.add(point, jnd_);
    count(point, snapshot, *set, std::clamp(time_s - last_time_s_, 0.0, kLongestStep_s));
  }
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_[i].dent.step(snapshot.tick.depth_m, static_cast<double>(point.force_N[i]),
                        std::abs(noticed_.sustained_over_jnd(i)), step_s);
  }
  if (!fresh) return;
  last_time_s_ = time_s;
  history_.append(point);
  fault_level_ = TickFaultLevel::none;
}

HistoryPoint Comparison::point_of(const LoopSnapshot& snapshot, const PublishedSet* set) {
  HistoryPoint point;
  point.loop_time_s = snapshot.loop_time_s;
  point.time_s = snapshot.tick.time_s;
  point.position_m = static_cast<float>(snapshot.tick.position_m);
  point.depth_m = static_cast<float>(snapshot.tick.depth_m);
  point.reference_N = static_cast<float>(reference_in(snapshot));
  point.rendered_N = static_cast<float>(snapshot.rendered_N);
  point.in_contact = snapshot.tick.in_contact;
  point.counts = settled_ && snapshot.tick.in_contact &&
                 (snapshot.tick.fault == TickFault::none || snapshot.tick.fault == TickFault::force_not_finite);
  point.out_of_domain = (snapshot.tick.out_of_domain_mask >> snapshot.selected & 1U) != 0;
  if (set == nullptr) return point;
  for (const auto& [slot, i] : set->models) {
    if (i == snapshot.selected) {
      point.active = static_cast<std::uint8_t>(slot);
      point.predicted_error_N = static_cast<float>(snapshot.tick.predicted_error_N[i]);
    }
    point.force_N[slot] = static_cast<float>(snapshot.tick.force_N[i]);
    if (models_.info(slot).other_material) point.other_material |= static_cast<std::uint16_t>(1U << slot);
  }
  return point;
}

void Comparison::count(const HistoryPoint& point, const LoopSnapshot& snapshot, const PublishedSet& set,
                       double step_s) {
  // Where one model is outside its training domain, the sample counts for no model.
  const bool outside = std::ranges::any_of(set.models, [&](const auto& model) {
    return !models_.info(model.first).other_material && (snapshot.tick.out_of_domain_mask >> model.second & 1U) != 0;
  });
  // A snapshot of an earlier set lacks the models that joined since.
  if (&set != models_.newest_set() || std::isnan(point.reference_N) || outside || !point.counts) return;
  counted_s_ += step_s;
  for (const auto& [slot, i] : set.models)
    if (!std::isnan(point.difference_over_jnd(slot, jnd_)))
      slots_[slot].errors.add(point.force_N[slot], point.reference_N, jnd_);
}

double Comparison::reference_in(const LoopSnapshot& snapshot) const noexcept {
  if (reference_ == ReferenceKind::measured) return snapshot.measured_N;
  if (reference_ == ReferenceKind::truth) return snapshot.reference_N;
  const PublishedSet* set = models_.set_of(snapshot);
  if (set == nullptr || !models_.reference()) return kNoForce;
  const std::size_t index = set->index_of(*models_.reference());
  return index < kMaxModels ? snapshot.tick.force_N[index] : kNoForce;
}

}  // namespace palpate
