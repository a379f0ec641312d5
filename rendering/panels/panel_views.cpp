#include "rendering/panels/panel_views.h"

#include <algorithm>
#include <cmath>

#include "scenes/live/live_session.h"

namespace palpate {
namespace {

// A hand that aims at the strongest press goes beyond it for a moment.
constexpr double kUsualOverStrongest = 1.5;

}  // namespace

std::vector<std::size_t> ModelsView::listed() const {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (slots[i]->state != SlotState::hidden) list.push_back(i);
  }
  return list;
}

std::size_t ModelsView::number_of(std::size_t slot) const {
  const std::vector<std::size_t> list = listed();
  return static_cast<std::size_t>(std::find(list.begin(), list.end(), slot) - list.begin()) + 1;
}

const SlotView* ModelsView::active() const noexcept {
  if (selected >= slots.size() || slots[selected]->state != SlotState::ready) return nullptr;
  return slots[selected];
}

bool ModelsView::out_of_domain() const noexcept {
  const SlotView* model = active();
  return in_contact && model != nullptr && model->out_of_domain;
}

ModelsView models_view(const LiveSession& session, double until_s) {
  ModelsView view;
  for (std::size_t i = 0; i < session.models().size(); ++i) view.slots.push_back(&session.models().view(i));
  view.selected = session.models().selected();
  view.in_contact = session.newest().tick.in_contact;
  const Comparison& comparison = session.comparison();
  view.compared = session.has_reference(comparison.reference());
  if (comparison.reference() == ReferenceKind::direct && view.compared) view.reference = *session.models().reference();
  view.off_from = session.reference_words(true);
  view.jnd = session.jnd();
  view.since = comparison.counted_since();
  view.now = comparison.history().last_until(until_s);
  return view;
}

ForceView force_view(const LiveSession& session, double until_s) {
  return {models_view(session, until_s), &session.comparison().history(), session.reference_words(),
          kUsualOverStrongest * session.scene().strongest_press_N};
}

HealthView health_view(const LiveSession& session) {
  HealthView view;
  view.loop = session.loop().statistics();
  view.scheduling = session.loop().scheduling();
  view.missed_of_late = session.faults().missed_of_late();
  view.now_s = session.newest().loop_time_s;
  view.faults = session.faults().events();
  view.alarms = session.alarms();
  view.device_name = session.device_name();
  view.device = session.newest().device;
  view.heat_share = static_cast<double>(session.newest().heat_share);
  view.stiffness_share = static_cast<double>(session.newest().stiffness_share);
  view.late_ms = static_cast<double>(session.newest().late_ms);
  return view;
}

}  // namespace palpate
