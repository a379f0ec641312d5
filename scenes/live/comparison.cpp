#include "scenes/live/comparison.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

// A longer gap between snapshots is a stall, in which the picture stood still.
constexpr double kLongestStep_s = 0.1;
// A tick takes several samples of a quick recording.
constexpr double kBeginning_s = 0.05;

}  // namespace

void Comparison::use_reference(ReferenceKind kind) {
  if (kind != reference_) forget_errors("the reference changed");
  reference_ = kind;
}

void Comparison::forget_errors(std::string why) {
  since_ = std::move(why);
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_.view(i).errors = {};
    slots_.view(i).quantile = {};
    slots_.view(i).samples_out_of_domain = 0;
  }
}

void Comparison::fit_slots() {
  if (figures_.size() < slots_.size()) figures_.resize(slots_.size());
}

void Comparison::begin_slot(std::size_t slot) {
  fit_slots();
  figures_[slot].dent = Dent(slots_.features(slot));
}

void Comparison::add(const LoopSnapshot& snapshot, TickTrouble trouble) {
  fit_slots();
  const PublishedSet* set = slots_.set_of(snapshot);
  const double step_s = std::clamp(snapshot.loop_time_s - last_loop_time_s_, 0.0, kLongestStep_s);
  last_loop_time_s_ = snapshot.loop_time_s;
  if (snapshot.restarted || set == nullptr)
    seen_out_of_contact_ = set != nullptr && snapshot.tick.time_s < begins_at_s_ + kBeginning_s;
  if (set != nullptr && !snapshot.tick.in_contact) seen_out_of_contact_ = true;
  HistoryPoint point = point_of(snapshot, set);
  point.trouble = trouble_ = std::max(trouble_, trouble);
  // A recording that stands still says nothing new.
  const bool fresh = snapshot.samples > 0;
  if (fresh && set != nullptr) count(point, snapshot, *set);
  for (Figures& figures : figures_) figures.dent.step(snapshot.tick.depth_m, figures.felt_over_jnd, step_s);
  if (!fresh) return;
  history_.append(point);
  trouble_ = TickTrouble::none;
}

HistoryPoint Comparison::point_of(const LoopSnapshot& snapshot, const PublishedSet* set) const {
  HistoryPoint point;
  point.loop_time_s = snapshot.loop_time_s;
  point.time_s = snapshot.tick.time_s;
  point.depth_m = static_cast<float>(snapshot.tick.depth_m);
  point.reference = static_cast<std::uint8_t>(reference_);
  point.reference_N = static_cast<float>(reference_in(snapshot, set));
  point.rendered_N = static_cast<float>(snapshot.rendered_N);
  point.in_contact = snapshot.tick.in_contact;
  point.counts = seen_out_of_contact_ && snapshot.tick.in_contact &&
                 (snapshot.tick.fault == TickFault::none || snapshot.tick.fault == TickFault::force_not_finite);
  point.out_of_domain = (snapshot.tick.out_of_domain_mask >> snapshot.selected & 1U) != 0;
  point.force_N.fill(std::nanf(""));
  point.predicted_error_N = std::nanf("");
  if (set == nullptr) return point;
  if (snapshot.selected < set->slots.size()) {
    point.active = static_cast<std::uint8_t>(set->slots[snapshot.selected]);
    point.predicted_error_N = static_cast<float>(snapshot.tick.predicted_error_N[snapshot.selected]);
  }
  for (std::size_t i = 0; i < set->slots.size(); ++i) {
    const std::size_t slot = set->slots[i];
    point.force_N[slot] = static_cast<float>(snapshot.tick.force_N[i]);
    if (slots_.view(slot).foreign) point.foreign |= static_cast<std::uint16_t>(1U << slot);
  }
  return point;
}

void Comparison::count(const HistoryPoint& point, const LoopSnapshot& snapshot, const PublishedSet& set) {
  // Where one model is out of domain, none is compared.
  bool outside = false;
  for (std::size_t i = 0; i < set.slots.size(); ++i)
    outside = outside || ((snapshot.tick.out_of_domain_mask >> i & 1U) != 0 && !slots_.view(set.slots[i]).foreign);
  // Of a set before the newest: a model that joined is not in it.
  const bool all_there = &set == slots_.newest_set();
  for (const std::size_t slot : set.slots) {
    Figures& figures = figures_[slot];
    const double difference = point.difference_over_jnd(slot, jnd_);
    figures.felt_over_jnd = figures.felt.add(point.time_s, std::isnan(difference) ? 0.0 : difference);
    if (!point.counts || !all_there || std::isnan(difference)) continue;
    SlotView& view = slots_.view(slot);
    if (outside) {
      ++view.samples_out_of_domain;
    } else {
      view.errors.add(static_cast<double>(point.force_N[slot]), static_cast<double>(point.reference_N), false, jnd_);
      view.quantile.add(std::abs(difference));
    }
  }
}

void Comparison::show(const LoopSnapshot& newest) {
  fit_slots();
  const PublishedSet* set = slots_.set_of(newest);
  reference_N_ = reference_in(newest, set);
  for (std::size_t i = 0; i < figures_.size(); ++i) {
    SlotView& view = slots_.view(i);
    view.dent_m = figures_[i].dent.depth_m();
    view.recent_peak_error_over_jnd = figures_[i].dent.error_over_jnd();
  }
  if (set == nullptr) return;
  for (std::size_t i = 0; i < set->slots.size(); ++i) {
    SlotView& view = slots_.view(set->slots[i]);
    view.force_N = newest.tick.force_N[i];
    view.predicted_error_N = newest.tick.predicted_error_N[i];
    view.out_of_domain = (newest.tick.out_of_domain_mask >> i & 1U) != 0;
  }
}

double Comparison::reference_in(const LoopSnapshot& snapshot, const PublishedSet* set) const noexcept {
  if (reference_ == ReferenceKind::measured) return snapshot.measured_N;
  if (reference_ == ReferenceKind::truth) return snapshot.reference_N;
  if (set == nullptr || !slots_.reference()) return kNoForce;
  const auto place = set->place_of(*slots_.reference());
  return place ? snapshot.tick.force_N[*place] : kNoForce;
}

}  // namespace palpate
