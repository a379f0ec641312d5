#include "scenes/live/comparison.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// A longer gap between snapshots is a stall, in which the picture stood still.
constexpr double kLongestStep_s = 0.1;

}  // namespace

void Comparison::use_reference(ReferenceKind kind) {
  reference_ = kind;
  forget_errors();
}

void Comparison::forget_errors() {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    slots_.view(i).errors = {};
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
  const double reference_N = reference_in(snapshot, set);
  const double step_s = std::clamp(snapshot.loop_time_s - last_loop_time_s_, 0.0, kLongestStep_s);
  last_loop_time_s_ = snapshot.loop_time_s;
  if (snapshot.restarted || set == nullptr) seen_out_of_contact_ = false;
  if (set != nullptr && !snapshot.tick.in_contact) seen_out_of_contact_ = true;
  HistoryPoint point;
  point.loop_time_s = snapshot.loop_time_s;
  point.depth_m = static_cast<float>(snapshot.tick.depth_m);
  point.reference_N = static_cast<float>(reference_N);
  point.rendered_N = static_cast<float>(snapshot.rendered_N);
  point.in_contact = snapshot.tick.in_contact;
  point.out_of_domain = (snapshot.tick.out_of_domain_mask >> snapshot.selected & 1U) != 0;
  point.trouble = trouble;
  point.force_N.fill(std::nanf(""));
  point.predicted_error_N = std::nanf("");
  if (set != nullptr) {
    if (snapshot.selected < set->slots.size()) {
      point.active = static_cast<std::uint8_t>(set->slots[snapshot.selected]);
      point.predicted_error_N = static_cast<float>(snapshot.tick.predicted_error_N[snapshot.selected]);
    }
    for (std::size_t i = 0; i < set->slots.size(); ++i) {
      point.force_N[set->slots[i]] = static_cast<float>(snapshot.tick.force_N[i]);
      add_to_slot(i, set->slots[i], snapshot, reference_N);
    }
  }
  for (Figures& figures : figures_) figures.dent.step(snapshot.tick.depth_m, figures.felt_over_jnd, step_s);
  history_.append(point);
}

void Comparison::add_to_slot(std::size_t index, std::size_t slot, const LoopSnapshot& snapshot, double reference_N) {
  Figures& figures = figures_[slot];
  const bool counts = seen_out_of_contact_ && snapshot.samples > 0 && snapshot.tick.in_contact &&
                      (snapshot.tick.fault == TickFault::none || snapshot.tick.fault == TickFault::force_not_finite);
  if (counts) figures.time.add(snapshot.evaluation_ns[index]);
  const bool compared = counts && std::isfinite(reference_N);
  const double force_N = snapshot.tick.force_N[index];
  const double difference = compared ? (force_N - reference_N) / jnd_.at(reference_N) : 0.0;
  figures.felt_over_jnd = figures.felt.add(snapshot.loop_time_s, difference);
  if (!compared) return;
  SlotView& view = slots_.view(slot);
  // Where one model is out of domain, none is compared.
  if (snapshot.tick.out_of_domain_mask != 0) {
    ++view.samples_out_of_domain;
  } else {
    view.errors.add(force_N, reference_N, false, jnd_);
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
    view.evaluation_ns = figures_[i].time.median_ns();
  }
  if (set == nullptr) return;
  const bool compared = newest.tick.in_contact && std::isfinite(reference_N_);
  for (std::size_t i = 0; i < set->slots.size(); ++i) {
    SlotView& view = slots_.view(set->slots[i]);
    view.force_N = newest.tick.force_N[i];
    view.predicted_error_N = newest.tick.predicted_error_N[i];
    view.out_of_domain = (newest.tick.out_of_domain_mask >> i & 1U) != 0;
    view.error_N = compared ? view.force_N - reference_N_ : 0.0;
    view.error_over_jnd = compared ? jnd_.error_over_jnd(view.force_N, reference_N_) : 0.0;
  }
}

double Comparison::reference_in(const LoopSnapshot& snapshot, const PublishedSet* set) const noexcept {
  switch (reference_) {
    case ReferenceKind::measured:
      return snapshot.measured_N;
    case ReferenceKind::truth:
      return snapshot.reference_N;
    case ReferenceKind::direct:
      break;
  }
  if (set == nullptr || !slots_.direct()) return kNoForce;
  const auto place = set->place_of(*slots_.direct());
  return place ? snapshot.tick.force_N[*place] : kNoForce;
}

}  // namespace palpate
