// The commands of the window, one row for each; a command has a key or a button.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "engine/live/pacer.h"
#include "rendering/app/demo_app.h"
#include "rendering/panels/window_view.h"
#include "scenes/worker/model_worker.h"

namespace palpate {
namespace {

// Speed of the tool while a key is held.
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

WindowCommand in_bar(WindowCommand command) {
  command.bar = true;
  return command;
}

WindowCommand in_replay(WindowCommand command) {
  command.replay = true;
  return command;
}

WindowCommand when(When when, WindowCommand command) {
  command.when = when;
  return command;
}

// Shows these words instead of the names of the keys.
WindowCommand shown_as(const char* shown, WindowCommand command) {
  command.shown = shown;
  return command;
}

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
  const auto first_is = [](bool& value) { return [&value](std::size_t i) { value = i == 0; }; };
  return {
      {GLFW_KEY_B, "Blocks", "one block, two, or one of each model and of the truth", names("1", "2", "all"),
       std::min<std::size_t>(settings.blocks - 1, 2),
       [this](std::size_t i) { use_block_count(i < 2 ? i + 1 : kAllBlocks); }},
      {GLFW_KEY_N, "Models", "the next set of models: comparison, sizes, corrections, direct", models, line_up,
       [this](std::size_t i) { use_line_up(line_ups()[i]); },
       "there is nothing to fit models to: O chooses a material, a recording is one too"},
      {GLFW_KEY_V, "Curves", "the difference in its band, or its mean over 50 ms",
       names("difference", "mean over 50 ms"), settings.difference ? 0U : 1U, first_is(settings.difference)},
      {GLFW_KEY_E, "Plot", "the error against the time that a model takes, or against the force",
       names("error against time", "error against force"), view_.verdict ? 0U : 1U, first_is(view_.verdict)},
      {GLFW_KEY_T, "Theme", "light or dark", names("light", "dark"), static_cast<std::size_t>(settings.theme),
       [&settings](std::size_t i) { settings.theme = static_cast<Theme>(i); }},
      {GLFW_KEY_D, "Push only while", "the device pushes only while G is held, only while its grip is held, or always",
       session_->renders_force() ? names("always", "G is held", "the grip is held") : names(),
       static_cast<std::size_t>(session_->controls().dead_man),
       [this](std::size_t i) { session_->controls().dead_man = static_cast<DeadMan>(i); },
       "there is no device that pushes: nothing to hold a switch for"}};
}

std::vector<WindowCommand> DemoApp::make_commands() {
  Settings& settings = view_.settings;
  Dialogs& dialogs = view_.dialogs;
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
  WindowCommand help = toggle(GLFW_KEY_H, "Help", "what the picture shows, and all keys", dialogs.help);
  help.keys.push_back(GLFW_KEY_SLASH);
  std::vector<WindowCommand> all{
      hint("mouse", "moves the probe, over the block; down is deeper"),
      hint("wheel", "moves the probe step by step; with Ctrl: zooms the view"),
      hint("right button", "turns the view"),
      when(When::held,
           keys({GLFW_KEY_DOWN, GLFW_KEY_UP}, "press deeper; lift the probe to just above the surface", press)),
      shown_as("1 ... 9", keys({GLFW_KEY_1, GLFW_KEY_2, GLFW_KEY_3, GLFW_KEY_4, GLFW_KEY_5, GLFW_KEY_6, GLFW_KEY_7,
                                GLFW_KEY_8, GLFW_KEY_9},
                               "make a model the active one; a click on its block or row too",
                               [this](std::size_t key) { select_listed(key); })),
      in_bar(toggle(GLFW_KEY_M, "Open", "open recordings, other programs' tables or models", dialogs.file_list)),
      in_bar(toggle(GLFW_KEY_O, "Scene", "choose another material", dialogs.scene_list)),
      in_bar(with_state(command(GLFW_KEY_U, "Device", "choose what holds the tool",
                                [this, &dialogs] {
                                  dialogs.device_list = !dialogs.device_list;
                                  if (dialogs.device_list) files_.look_for_devices();
                                }),
                        [&dialogs] { return dialogs.device_list; })),
      in_bar(with_state(
          command(GLFW_KEY_R, "Record", "record this session to a file that `palpate fit` reads",
                  [this] { files_.record(*session_); }),
          [this] { return session_->recording().active; }, "Stop recording")),
      in_bar(toggle(GLFW_KEY_W, "View", "choose what is shown, and what is compared with what", dialogs.view_list)),
      help,
      with_state(
          command(GLFW_KEY_SPACE, "Freeze", "freeze curves and picture to look back; continue",
                  [this] { view_.time.paused ? view_.time.run() : view_.time.pause(steady_now_s()); }),
          [this] { return view_.time.paused; }, "Go on"),
      command(GLFW_KEY_C, "Clear", "clear the errors so far and the alarms", [this] { session_->reset_figures(); }),
      toggle(GLFW_KEY_X, "Arrows x 10", "arrows that show ten times the difference, and back", view_.exaggerated),
      with_state(command(GLFW_KEY_J, "Feel", "scale the stiffness and damping of the rendered force; back to the model",
                         [this] {
                           view_.scales_force = !view_.scales_force;
                           session_->controls().scale = {};
                         }),
                 [this] { return view_.scales_force; }),
      command(GLFW_KEY_S, "Save curves", "save what the curves show, as a figure and as data",
              [this] { files_.save_curves(*session_, shown_, curves_.columns()); }),
      command(GLFW_KEY_K, "Save model", "save the active model to a file", [this] { files_.save_model(*session_); }),
      hint("a row, right button", "renames a model, takes it out"),
      hint("on the curves", "drag: zoom; wheel: scroll back; double click: continue"),
      when(When::held,
           keys({GLFW_KEY_LEFT, GLFW_KEY_RIGHT}, "scroll back and forth while the curves stand still", scroll)),
      in_replay(with_state(
          command(GLFW_KEY_P, "Pause", "pause a replayed recording and its curves, and play on",
                  [this] {
                    session_->replay()->pause(!session_->replay()->paused());
                    view_.time.run();
                  }),
          [this] { return session_->replay() != nullptr && session_->replay()->paused(); }, "Play")),
      in_replay(command(GLFW_KEY_BACKSPACE, "Back to the hand", "end the replay and press the block yourself",
                        [this] { use_device(first_device_); })),
      in_replay(when(When::repeated, command(GLFW_KEY_COMMA, "<", "one sample back; the recording pauses",
                                             [this] { session_->replay()->step(-1); }))),
      in_replay(when(When::repeated, command(GLFW_KEY_PERIOD, ">", "one sample forward; the recording pauses",
                                             [this] { session_->replay()->step(1); }))),
      in_replay(keys({GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_DOWN}, "2 s back or forward in a recording",
                     [seek](std::size_t key) { seek(key == 0 ? -kSeekStep_s : kSeekStep_s); })),
      in_replay(keys({GLFW_KEY_LEFT_BRACKET, GLFW_KEY_RIGHT_BRACKET}, "play a recording slower or faster",
                     [play_at](std::size_t key) { play_at(key == 0 ? 1.0 / kSpeedStep : kSpeedStep); })),
      toggle(GLFW_KEY_L, "Loop", "all figures of the loop, and its faults", view_.details),
      command(GLFW_KEY_Z, "", "the device's tool is at its rest position: zero it there",
              [this] { session_->start_zeroing(); }),
      when(When::held, command(GLFW_KEY_G, "", "hold it to let the device push, if D requires it",
                               [this] {
                                 if (session_->controls().dead_man == DeadMan::key)
                                   session_->controls().held_s = steady_now_s();
                               })),
      command(GLFW_KEY_HOME, "", "the view as it was at the beginning", [this] { blocks_->camera().go_home(); }),
      shown_as("+",
               keys({GLFW_KEY_EQUAL, GLFW_KEY_KP_ADD}, "larger text", [resize](std::size_t) { resize(kTextStep); })),
      shown_as("-", keys({GLFW_KEY_MINUS, GLFW_KEY_KP_SUBTRACT}, "smaller text",
                         [resize](std::size_t) { resize(-kTextStep); })),
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
  if (number < listed.size()) session_->models().select(listed[number]);
}

void DemoApp::use_block_count(std::size_t wanted) {
  view_.settings.blocks = wanted;
  // Says why there are fewer blocks than the user selected.
  const bool reference = shown_.models.compared && shown_.models.reference == kReferenceBlock && wanted > 1;
  const std::size_t shown = shown_.models.drawn().size() + (reference ? 1 : 0);
  if (wanted == 2 && shown < wanted)
    notify(std::to_string(shown) + " of " + std::to_string(wanted) + " blocks: no more models are ready", false);
}

void DemoApp::close_windows() {
  view_.dialogs = {};
  view_.details = false;
}

void DemoApp::use_line_up(const LineUp& line_up) {
  session_->use_line_up(line_up.name);
  request_.line_up = line_up.name;
  request_.models.clear();
  notify(std::string(line_up.name) + ": " + line_up.help, false);
}

}  // namespace palpate
