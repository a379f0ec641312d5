// The commands of the window, one row for each; a command has a key or a button.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

#include "engine/live/pacer.h"
#include "rendering/app/demo_app.h"
#include "scenes/worker/model_worker.h"

namespace palpate {
namespace {

constexpr double kKeySpeed_m_per_s = 0.018;
constexpr double kScrollSpeed = 6.0;  // seconds per second
constexpr double kSeekStep_s = 2.0;
constexpr double kSpeedStep = 1.25;
constexpr float kTextStep = 0.1F;

using When = WindowCommand::When;

// An input without a command, for the list of keys.
WindowCommand hint(const char* shown, const char* help) { return {.shown = shown, .help = help}; }

// A command of several keys; `run` gets the index of the key.
WindowCommand keys(std::vector<int> keys, const char* help, std::function<void(std::size_t)> run) {
  return {.keys = std::move(keys), .help = help, .run = std::move(run)};
}

// A command of one key; with a label it has a menu item.
WindowCommand command(int key, const char* label, const char* help, std::function<void()> run) {
  return {.keys = {key}, .label = label, .help = help, .run = [run = std::move(run)](std::size_t) { run(); }};
}

// Shows whether the command is switched on, with `label_on` as its label then, if that is not empty.
WindowCommand with_state(WindowCommand command, std::function<bool()> on, const char* label_on = "") {
  command.on = std::move(on);
  command.label_on = label_on;
  return command;
}

// A command that switches a setting, which lives as long as the commands; with a label its item shows the state.
WindowCommand toggle(int key, const char* label, const char* help, bool& setting) {
  return with_state(command(key, label, help, [&setting] { setting = !setting; }), [&setting] { return setting; });
}

WindowCommand dialog(int key, const char* label, const char* help, Dialog one, Dialog& open) {
  return with_state(command(key, label, help, [one, &open] { open = open == one ? Dialog::none : one; }),
                    [one, &open] { return open == one; });
}

// The command with another value of a field.
template <typename Value>
WindowCommand with(Value WindowCommand::*field, std::type_identity_t<Value> value, WindowCommand command) {
  command.*field = std::move(value);
  return command;
}
WindowCommand in_bar(WindowCommand command) { return with(&WindowCommand::bar, true, std::move(command)); }
WindowCommand in_replay(WindowCommand command) { return with(&WindowCommand::replay, true, std::move(command)); }

}  // namespace

std::vector<WindowChoice> DemoApp::choices() {
  constexpr auto kNone = static_cast<std::size_t>(-1);
  Settings& settings = view_.settings;
  std::vector<std::string> models;
  std::size_t line_up = kNone;
  if (session_->scene().has_material())
    for (const LineUp& one : line_ups()) models.push_back(one.name);
  if (const LineUp* one = find_line_up(session_->line_up())) line_up = static_cast<std::size_t>(one - &line_ups()[0]);
  const auto names = [](auto... all) { return std::vector<std::string>{all...}; };
  return {{GLFW_KEY_B, "Blocks", "one block, two models beside the truth, or one of each model and of the truth",
           names("1", "2", "all"), std::min<std::size_t>(settings.blocks - 1, 2),
           [this](std::size_t i) { use_block_count(i < 2 ? i + 1 : kAllBlocks); }},
          {GLFW_KEY_N, "New models", "the next set of models: comparison, sizes, corrections, direct", models, line_up,
           [this](std::size_t i) { use_line_up(line_ups()[i]); },
           "there is nothing to fit models to: S chooses a material, a recording is one too"},
          {GLFW_KEY_T, "Theme", "light or dark", names("light", "dark"), static_cast<std::size_t>(settings.theme),
           [&settings](std::size_t i) { settings.theme = static_cast<Theme>(i); }},
          {GLFW_KEY_A, "Allow force", "the device pushes only while G is held, only while its grip is held, or always",
           session_->renders_force() ? names("always", "G is held", "the grip is held") : names(),
           static_cast<std::size_t>(session_->controls().dead_man),
           [this](std::size_t i) { session_->controls().dead_man = static_cast<DeadMan>(i); },
           "there is no device that pushes: nothing to hold a switch for"}};
}

std::vector<WindowCommand> DemoApp::make_commands() {
  Settings& settings = view_.settings;
  Dialog& open = view_.dialogs.open;
  const auto press = [this](std::size_t key) { key_velocity_m_per_s_ += (key == 0 ? 1.0 : -1.0) * kKeySpeed_m_per_s; };
  const auto scroll = [this](std::size_t key) {
    const ForceHistory& history = session_->comparison().history();
    const double by_s = kScrollSpeed * ImGui::GetIO().DeltaTime;
    if (history.size() > 0) view_.time.scroll_back(key == 0 ? by_s : -by_s, history[0].loop_time_s);
  };
  const auto play_at = [this](double speed) { session_->replay()->set_speed(speed * session_->replay()->speed()); };
  const auto seek = [this](double by_s) { session_->replay()->seek(session_->replay()->playhead_s() + by_s); };
  const auto resize = [&settings](float step) {
    settings.text_size = std::clamp(settings.text_size + step, kSmallestText, kLargestText);
  };
  WindowCommand help = dialog(GLFW_KEY_H, "Help", "what the picture shows, and all keys", Dialog::help, open);
  help.keys.push_back(GLFW_KEY_SLASH);
  std::vector<WindowCommand> all{
      hint("left button", "press it on a block and pull down: the probe presses; let go: it is lifted"),
      hint("wheel", "moves the probe step by step; with Ctrl: zooms the view"),
      hint("right button", "turns the view"),
      with(&WindowCommand::when, When::held,
           keys({GLFW_KEY_DOWN, GLFW_KEY_UP}, "press deeper; lift the probe to just above the surface", press)),
      with(&WindowCommand::shown, "1 ... 9",
           keys({GLFW_KEY_1, GLFW_KEY_2, GLFW_KEY_3, GLFW_KEY_4, GLFW_KEY_5, GLFW_KEY_6, GLFW_KEY_7, GLFW_KEY_8,
                 GLFW_KEY_9},
                "choose a model, or the true material after the last; a click on its block or row too",
                [this](std::size_t key) { select_listed(key); })),
      in_bar(dialog(GLFW_KEY_O, "Open", "open recordings, other programs' tables or models", Dialog::files, open)),
      in_bar(dialog(GLFW_KEY_S, "Scene", "choose another material", Dialog::scenes, open)),
      in_bar(dialog(GLFW_KEY_D, "Device", "choose what holds the tool", Dialog::devices, open)),
      in_bar(with_state(
          command(GLFW_KEY_R, "Record", "record this session to a file that `palpate fit` reads",
                  [this] { files_.record(*session_); }),
          [this] { return session_->recording().active; }, "Stop recording")),
      in_bar(dialog(GLFW_KEY_V, "View", "choose what is shown, and what is compared with what", Dialog::view, open)),
      in_bar(dialog(GLFW_KEY_E, "Export", "save picture, curves, table or model", Dialog::exports, open)),
      help,
      with_state(
          command(GLFW_KEY_SPACE, "Stop", "stop blocks, curves, numbers and a replay to look back; continue",
                  [this] { stop_or_go_on(); }),
          [this] { return view_.time.paused; }, "Go on"),
      command(GLFW_KEY_W, "Worst", "the moment of the active model's largest error, of the test, then of this session",
              [this] { use_worst(session_->models().selected()); }),
      command(GLFW_KEY_M, "", "the menu", [this] { view_.opens_menu = true; }),
      command(GLFW_KEY_C, "Clear", "clear the errors so far and the alarms", [this] { session_->reset_figures(); }),
      toggle(GLFW_KEY_X, "Arrows x 10", "arrows that show ten times the difference, and back", view_.exaggerated),
      with_state(command(GLFW_KEY_F, "Feel", "scale the stiffness and damping of the rendered force; back to the model",
                         [this] {
                           view_.scales_force = !view_.scales_force;
                           session_->controls().scale = {};
                         }),
                 [this] { return view_.scales_force; }),
      hint("Tab", "moves a focus through the buttons; Enter or Space presses it"),
      hint("a row", "Shift and click: two models beside the truth; x: takes it out"),
      hint("on the curves", "drag: the moment that is shown; Shift and drag: zoom; wheel: scroll; double click: go on"),
      with(&WindowCommand::when, When::held,
           keys({GLFW_KEY_LEFT, GLFW_KEY_RIGHT}, "scroll back and forth while the curves stand still", scroll)),
      in_replay(command(GLFW_KEY_BACKSPACE, "Back to the hand", "end the replay and press the block yourself",
                        [this] { use_device(first_device_); })),
      in_replay(with(&WindowCommand::when, When::repeated,
                     command(GLFW_KEY_COMMA, "<", "one sample back; the recording pauses",
                             [this] { session_->replay()->step(-1); }))),
      in_replay(with(&WindowCommand::when, When::repeated,
                     command(GLFW_KEY_PERIOD, ">", "one sample forward; the recording pauses",
                             [this] { session_->replay()->step(1); }))),
      in_replay(keys({GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN}, "2 s back or forward in a recording",
                     [seek](std::size_t key) { seek(key == 0 ? -kSeekStep_s : kSeekStep_s); })),
      in_replay(keys({GLFW_KEY_LEFT_BRACKET, GLFW_KEY_RIGHT_BRACKET}, "play a recording slower or faster",
                     [play_at](std::size_t key) { play_at(key == 0 ? 1.0 / kSpeedStep : kSpeedStep); })),
      toggle(GLFW_KEY_L, "Loop", "the faults of the loop", view_.details),
      command(GLFW_KEY_Z, "", "the device's tool is at its rest position: zero it there",
              [this] { session_->start_zeroing(); }),
      with(&WindowCommand::when, When::held,
           command(GLFW_KEY_G, "", "hold it to let the device push, if A requires it",
                   [this] {
                     if (session_->controls().dead_man == DeadMan::key) session_->controls().held_s = steady_now_s();
                   })),
      command(GLFW_KEY_HOME, "", "the view as it was at the beginning", [this] { blocks_->camera().go_home(); }),
      with(&WindowCommand::shown, "+",
           keys({GLFW_KEY_EQUAL, GLFW_KEY_KP_ADD}, "larger text", [resize](std::size_t) { resize(kTextStep); })),
      with(&WindowCommand::shown, "-",
           keys({GLFW_KEY_MINUS, GLFW_KEY_KP_SUBTRACT}, "smaller text", [resize](std::size_t) { resize(-kTextStep); })),
      command(GLFW_KEY_ESCAPE, "", "closes lists, questions and this", [this] { close_windows(); }),
      hint("drop a file", "loads a model; recordings and other programs' tables: trains or tests on them"),
      {.keys = {GLFW_KEY_Q}, .help = "ends the program", .run = [this](std::size_t) { close(); }, .control = true}};
  std::vector<WindowCommand> next;
  for (const WindowChoice& choice : choices())
    next.push_back(command(choice.key, "", choice.help, [this, index = next.size()] {
      const WindowChoice now = choices()[index];
      if (!now.names.empty()) return now.set((now.now + 1) % now.names.size());
      if (now.why_none[0] != '\0') notify(now.why_none, false);
    }));
  all.insert(all.end() - 3, next.begin(), next.end());  // before those that end something
  return all;
}

void DemoApp::select_listed(std::size_t number) {
  const std::vector<std::size_t> listed = shown_.models.listed();
  if (number < listed.size()) actions_.select(listed[number]);
  if (number == listed.size() && shown_.models.reference == kReferenceBlock) view_.material = shown_.models.compared;
}

void DemoApp::use_block_count(std::size_t wanted) {
  view_.settings.blocks = wanted;
  const auto ready = std::ranges::count(shown_.models.slots, SlotState::ready, &ModelView::state);
  if (wanted == 2 && ready < 2) notify("two models are needed, and " + std::to_string(ready) + " are ready", false);
}

// Everything stands still or nothing: blocks, curves, numbers, a replay.
void DemoApp::stop_or_go_on() {
  const bool stop = !view_.time.paused;
  leave_worst();
  if (ReplayControl* replay = session_->replay()) replay->pause(stop);
  stop ? view_.time.pause(shown_.now_s) : view_.time.run();
}

// The largest error of the test; of this session, when that is shown already; and back.
void DemoApp::use_worst(std::size_t slot) {
  const bool had = view_.worst && view_.worst->slot == slot;
  const bool had_test = had && view_.worst->history, had_session = had && !view_.worst->history;
  leave_worst();
  if (had_session) return view_.time.run();
  actions_.select(slot);
  auto found = session_->worst(slot, !had_test, view_.time.zero_s);
  if (!found) return notify("no error is known yet: press the block, or wait for the test", false);
  constexpr double kAfter_s = 1.5, kShown_around_s = 5.0;
  const ForceHistory& ticks = found->history ? *found->history : session_->comparison().history();
  view_.time.run();
  view_.time.pause(found->at_s + kAfter_s);
  view_.time.shown_s = std::clamp(found->at_s + kAfter_s - ticks[0].loop_time_s, kLeastShown_s, kShown_around_s);
  view_.time.rest_s = found->at_s;
  view_.worst = std::move(found);
  if (session_->replay() != nullptr) session_->replay()->pause(true);
  curves_ = {};
}

void DemoApp::leave_worst() {
  if (!view_.worst) return;
  view_.worst.reset();
  view_.time.run();
  curves_ = {};
}

void DemoApp::close_windows() {
  view_.dialogs = {};
  view_.details = false;
  view_.focus = -1;
}

void DemoApp::use_line_up(const LineUp& line_up) {
  session_->use_line_up(line_up.name);
  request_.line_up = line_up.name;
  request_.models.clear();
  notify(std::string(line_up.name) + ": " + line_up.help, false);
}

}  // namespace palpate
