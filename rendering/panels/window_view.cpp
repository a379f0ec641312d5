#include "rendering/panels/window_view.h"

#include "engine/base/text.h"

namespace palpate {
namespace {

// The slots with a block. If there is too little room, the active model and that of the verdict come first.
std::vector<std::size_t> slots_of_blocks(const ModelsView& models, bool reference, std::size_t block_count) {
  const std::size_t room = reference ? block_count - 1 : block_count;
  const auto rank = [&](std::size_t slot) {
    return slot == models.selected ? 0 : models.verdict.chosen == slot ? 1 : 2;
  };
  std::vector<std::size_t> slots = models.drawn();
  std::sort(slots.begin(), slots.end(),
            [&](std::size_t a, std::size_t b) { return std::pair(rank(a), a) < std::pair(rank(b), b); });
  slots.resize(std::min(slots.size(), room));
  std::sort(slots.begin(), slots.end());
  if (reference) slots.push_back(kReferenceBlock);
  return slots;
}

// The samples that the errors cover.
std::string counted_words(const LiveSession& session) {
  if (!session.test().has_recording()) {
    return session.has_reference() ? fixed(session.comparison().counted_s(), 1) + " s of contact"
                                   : session.reference_words(true);
  }
  const auto models = session.models().ready_slots();
  const std::uint64_t samples = models.empty() ? 0 : session.figures(models.front()).errors.samples;
  return (samples > 0 ? with_thousands(std::to_string(samples)) + " samples in contact of " : "") + session.test_name();
}

// While a replay is paused, the history gets no ticks. Shows the forces at its playhead of models that became ready
// since, and a new reference.
void show_newest(const LiveSession& session, ModelsView& view) {
  view.now.reference_N = static_cast<float>(session.comparison().reference_in(session.newest()));
  for (std::size_t i = 0; i < view.slots.size(); ++i)
    if (view.slots[i].state == SlotState::ready) view.now.force_N[i] = static_cast<float>(view.slots[i].force_N);
}

// The other of the two models that two blocks compare: the one that the user chose, else the first other one.
std::optional<std::size_t> second_of(const ModelsView& models, const ViewState& view) {
  if (view.settings.blocks != 2 || view.exhibit.on) return std::nullopt;
  std::optional<std::size_t> second;
  for (const std::size_t slot : models.listed()) {
    if (slot == models.selected || models.slots[slot].state != SlotState::ready) continue;
    if (!second || slot == view.second) second = slot;
  }
  return second;
}

ModelsView models_view(const LiveSession& session, const ViewState& view_state, const ForceHistory& history) {
  const double until_s = view_state.time.at_s(std::numeric_limits<double>::infinity());
  ModelsView view;
  for (std::size_t i = 0; i < session.models().size(); ++i)
    view.slots.push_back({session.models().info(i), session.figures(i)});
  view.selected = session.models().selected();
  view.second = second_of(view, view_state);
  view.stands = std::isfinite(until_s);
  const Comparison& comparison = session.comparison();
  view.compared = session.has_reference();
  if (comparison.reference() == ReferenceKind::model && view.compared) view.reference = *session.models().reference();
  view.reference_name = session.reference_words(true);
  view.counted = counted_words(session);
  if (session.test().has_recording()) view.test_name = session.test_name();
  view.replays_training = session.replay() != nullptr && session.tests_training();
  view.jnd = session.jnd();
  view.verdict = session.verdict();
  if (const HistoryPoint* now = history.last_until(until_s)) {
    view.now = *now;
  } else if (history.size() > 0) {
    view.now = history[0];  // a pause that is longer than the history
  }
  if (session.replay() != nullptr && session.replay()->paused() && !view.stands) show_newest(session, view);
  return view;
}

}  // namespace

std::vector<std::size_t> ModelsView::listed() const {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < slots.size(); ++i)
    if (slots[i].state != SlotState::hidden && slots[i].state != SlotState::equal) list.push_back(i);
  return list;
}

std::vector<std::size_t> ModelsView::drawn() const {
  std::vector<std::size_t> list = listed();
  std::erase_if(list, [&](std::size_t slot) {
    return slots[slot].state != SlotState::ready || (second && slot != selected && slot != *second);
  });
  std::stable_partition(list.begin(), list.end(), [&](std::size_t slot) { return slot != selected; });
  return list;
}

std::size_t ModelsView::number_of(std::size_t slot) const {
  const std::vector<std::size_t> list = listed();
  return static_cast<std::size_t>(std::find(list.begin(), list.end(), slot) - list.begin()) + 1;
}

const ModelView* ModelsView::active() const noexcept {
  if (selected >= slots.size() || slots[selected].state != SlotState::ready) return nullptr;
  return &slots[selected];
}

bool ModelsView::out_of_domain() const noexcept {
  const ModelView* model = active();
  return now.in_contact && model != nullptr && model->out_of_domain && !replays_training;
}

std::string data_warning(const ModelsView& models) {
  if (!models.out_of_domain()) return {};
  return "No such motion was recorded: here " + models.active()->name + " renders only its trend";
}

BigNumber big_number(const ModelsView& models) {
  BigNumber big;
  if (models.slots.empty()) return big;
  big.number = "–";
  const ModelView* active = models.active();
  if (active == nullptr) return big;
  if (!models.compared) {
    big.error_over_jnd =
        models.now.in_contact ? active->predicted_error_N / models.jnd.at(active->force_N) : std::nan("");
    if (!std::isnan(big.error_over_jnd)) big.number = jnd_text(big.error_over_jnd);
    big.what = "of a JND: 95 % bound of the error of " + active->name;
    big.below = models.reference_name;
    return big;
  }
  if (active->is_judged() && models.selected != models.reference) {
    big.error_over_jnd = active->errors.p99_error_over_jnd;
    big.number = jnd_text(big.error_over_jnd);
  }
  big.what = "of a JND in 99 % of " + std::string(models.test_name.empty() ? "your presses" : "the test") + ": " +
             active->name;
  const double press = models.now.press_over_jnd[models.selected];
  if (std::isnan(press) || models.selected == models.reference) return big;
  big.press_over_jnd = press;
  big.below = jnd_text(press) + (models.reference == kReferenceBlock ? "" : " from " + models.reference_name) +
              " in this press";
  return big;
}

std::string table_csv(const ModelsView& models) {
  std::string csv = "# " + models.counted + "\nmodel,centres,p99_error_over_jnd,within_jnd,tick_ns\n";
  for (const std::size_t slot : models.listed()) {
    const ModelView& one = models.slots[slot];
    const auto number = [](bool known, double value) { return known ? general(value, 6) : std::string(); };
    csv += one.name + "," + std::to_string(one.centres) + "," + number(one.is_judged(), one.errors.p99_error_over_jnd) +
           "," + number(one.is_judged(), one.errors.within_jnd) + "," + number(one.tick_ns() > 0.0, one.tick_ns()) +
           "\n";
  }
  return csv;
}

WindowView window_view(const LiveSession& session, const ViewState& view) {
  WindowView shown;
  shown.history = view.worst && view.worst->history ? view.worst->history.get() : &session.comparison().history();
  if (view.worst) shown.of_test = view.worst->history;
  shown.models = models_view(session, view, *shown.history);
  shown.health = {.loop = session.loop().statistics(),
                  .scheduling = session.loop().scheduling(),
                  .newest = session.newest(),
                  .missed_of_late = session.faults().missed_of_late(),
                  .faults = session.faults().events(),
                  .alarms = session.alarms(),
                  .device_name = session.device_name()};
  shown.scene = &session.scene();
  shown.device_words = session.device_words();
  shown.tool = session.tool_input();
  shown.hand_explores = shown.tool != nullptr && shown.tool->hand_is_exploring();
  shown.renders_force = session.renders_force();
  shown.settled = session.models().all_settled();
  shown.scale = session.controls().scale;
  shown.recording = session.recording();
  shown.replay = session.replay();
  shown.surface_m = shown.replay != nullptr ? session.test().found_m() : 0.0;
  shown.surface_moved = session.test().moved();
  const std::size_t blocks = view.settings.blocks;
  const bool has_truth = session.comparison().reference() != ReferenceKind::model;
  if (view.material && has_truth && blocks == 1) {
    shown.blocks = {kReferenceBlock};
  } else {
    shown.blocks = slots_of_blocks(shown.models, has_truth && blocks > 1, blocks == 2 ? 3 : blocks);
  }
  shown.reference_block = session.comparison().reference() == ReferenceKind::truth ? "the true material"
                          : shown.replay != nullptr                                ? "as recorded"
                                                                                   : "the real block";
  shown.reference_words = session.reference_words();
  shown.usual_depth_m = session.models().trained_depth_m();
  const bool stands = shown.replay != nullptr && shown.replay->paused() && shown.history->size() > 0;
  shown.now_s = stands ? (*shown.history)[shown.history->size() - 1].loop_time_s : steady_now_s();
  return shown;
}

}  // namespace palpate
