// palpate-demo: the window program's command line.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <utility>

#include "engine/base/files.h"
#include "engine/base/signals.h"
#include "engine/base/text.h"
#include "engine/live/pacer.h"
#include "rendering/app/demo_app.h"
#include "rendering/app/study_app.h"
#include "scenes/scene/scene.h"
#include "scenes/study/study_file.h"
#include "scenes/worker/model_worker.h"

namespace palpate {
namespace {

// Time of a screenshot without --seconds, when all models are fitted and the curves are full.
constexpr double kPictureAfter_s = 12.0;
// This scene has no block; the study presents two forces.
constexpr const char* kStudyScene = "jnd_study";

struct Arguments {
  DemoRequest demo;
  double seconds = 0.0;  // 0: until the window is closed
  std::string screenshot, stats;
  bool force = false, bridge_remote = false;
  std::optional<std::string> discriminate;  // the recording; empty: a virtual one
  std::string test;                         // the recording to replay; empty: none
  std::vector<std::string> files;
};

int fail(const std::string& message, int code = 1) {
  std::fprintf(stderr, "error: %s\n", printable(message, std::string::npos).c_str());
  return code;
}

void add_options(CLI::App& app, Arguments& arguments) {
  SessionRequest& session = arguments.demo.session;
  app.add_option("--scene", session.scene,
                 "Scene, see `palpate scenes`; jnd_study measures a hand [silicone_block; of model files their own]");
  app.add_option("--device", session.device, "auto, mouse, hid, hand, replay:REC.csv or bridge:TARGET")
      ->capture_default_str();
  app.add_flag("--bridge-remote", arguments.bridge_remote, "bridge:tcp: may name another computer");
  app.add_option("--model", session.models,
                 "Models: files, or methods (palpate fit --list-methods names them) [the scene's]")
      ->type_name("FILE_OR_METHOD");
  app.add_option("files", arguments.files, "Models, or recordings or other programs' tables to train or to test on")
      ->type_name("FILE");
  app.add_option(
         "--train", session.recordings,
         "Recordings that models are fitted to, as one training set; without --test, the end of the last is the test")
      ->type_name("REC.csv");
  app.add_option("--test", arguments.test, "Replay this recording; models are judged on it, and not fitted to it")
      ->type_name("REC.csv")
      ->excludes("--device");
  app.add_option_function<std::string>(
         "--discriminate", [&arguments](const std::string& recording) { arguments.discriminate = recording; },
         "Blind test: can a person tell model from recording? A stroke of this recording [a virtual one], rendered by "
         "two models, or by one and as recorded")
      ->type_name("[REC.csv]")
      ->expected(0, 1);
  app.add_option("--seconds", arguments.seconds, "Exit after this many seconds")
      ->check(CLI::Range(0.1, 1e6))
      ->check([](const std::string& text) {
        return std::isnan(std::atof(text.c_str())) ? "found nan, expected a number" : "";
      });
  app.add_option("--screenshot", arguments.screenshot, "Save the window as it is at the end [after 12 s], then end")
      ->type_name("PNG");
  app.add_option("--stats", arguments.stats,
                 "At the end write the timing of loop and picture, the errors of the models and the faults")
      ->type_name("JSON");
  app.add_flag("--fullscreen", arguments.demo.window.fullscreen, "Fill the screen");
  app.add_flag("--kiosk", arguments.demo.exhibit,
               "Full-screen game for visitors. Ctrl+Shift+T: the host's figures; Ctrl+Shift+Q: quit");
  app.add_flag("--force", arguments.force, "Replace existing files");
}

// Reports at the start if an output cannot be written.
Status check_outputs(const Arguments& arguments) {
  for (const std::string& path : {arguments.screenshot, arguments.stats}) {
    if (path.empty()) continue;
    if (const auto trial = AtomicFile::create(path, arguments.force); !trial) return trial.error();
  }
  return {};
}

// The window asks for the role of recordings; all other files are models.
void sort_files(Arguments& arguments) {
  SessionRequest& session = arguments.demo.session;
  for (const std::string& file : arguments.files)
    (may_be_recording(file) ? arguments.demo.recordings : session.models).push_back(file);
  if (session.models.empty() && !arguments.demo.exhibit) session.line_up = line_ups().front().name;
}

// Draws frames until the window is closed, a signal arrives, or `seconds` have passed. The first signal has the effect
// of closing the window: the force goes to zero and a recording is saved.
template <typename App>
void run_frames(App& app, double seconds) {
  const double start_s = steady_now_s();
  while (!app.closing() && stop_requested() == 0) {
    app.frame();
    if (seconds > 0.0 && steady_now_s() - start_s >= seconds) break;
  }
}

Status run_study(const Arguments& arguments) {
  std::function<StudyApp::Strokes()> prepare;
  if (arguments.discriminate) {
    prepare = [&]() -> StudyApp::Strokes {
      const std::string& scene = arguments.demo.session.scene;
      auto prepared = prepare_strokes(scene.empty() ? "silicone_block" : scene, arguments.demo.session.models,
                                      *arguments.discriminate);
      if (!prepared) return prepared.error();
      return std::shared_ptr<const StrokePair>(std::move(*prepared));
    };
  }
  auto app = StudyApp::create(arguments.demo.window, arguments.demo.session.device, prepare);
  if (!app) return app.error();
  run_frames(**app, arguments.seconds);
  return arguments.screenshot.empty() ? Status() : (*app)->screenshot(arguments.screenshot, arguments.force);
}

Status run_demo(Arguments& arguments) {
  if (Status status = check_outputs(arguments); !status) return status;
  std::string& device = arguments.demo.session.device;
  if (arguments.bridge_remote) allow_remote_bridges();
  if (arguments.demo.exhibit) arguments.demo.window.fullscreen = true;
  if (!arguments.screenshot.empty() && arguments.seconds == 0.0) arguments.seconds = kPictureAfter_s;
  if (arguments.discriminate || arguments.demo.session.scene == kStudyScene) return run_study(arguments);
  // A screenshot does not depend on the user's settings.
  if (const auto folder = config_folder(); folder && arguments.screenshot.empty())
    arguments.demo.settings_file = *folder + "/window.json";
  sort_files(arguments);
  arguments.demo.session.ready_models = ready_models_folder();
  // Without a test recording, the end of the last training recording is replayed.
  const std::vector<std::string>& training = arguments.demo.session.recordings;
  if (arguments.test.empty() && !training.empty() && device == "auto") arguments.test = training.back();
  if (!arguments.test.empty()) device = "replay:" + arguments.test;
  auto created = DemoApp::create(arguments.demo);
  if (!created) return created.error();
  // It is not destroyed, because it would wait for a fit; `main` ends the program.
  DemoApp& app = *created->release();
  Status written;
  const auto write_stats = [&](const std::string& text) {
    const std::string path = std::exchange(arguments.stats, "");
    if (!path.empty() && !text.empty()) written = write_file_atomically(path, text, arguments.force);
  };
  Window::at_loss_of_display([&] { write_stats(app.end()); });
  run_frames(app, arguments.seconds);
  Status status = app.outcome();
  if (status && !arguments.screenshot.empty()) status = app.screenshot(arguments.screenshot, arguments.force);
  if (status) write_stats(stats_text(app.session(), app.shown(), app.view().frames));
  Window::at_loss_of_display(nullptr);
  app.finish();
  return status ? written : status;
}

// The first option that is not known, with the nearest one; empty if all are known.
std::string unknown_option(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options())
    known.insert(known.end(), option->get_lnames().begin(), option->get_lnames().end());
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::string name = word.rfind("--", 0) == 0 ? word.substr(2, word.find('=') - 2) : "";
    if (name.empty() || std::ranges::find(known, name) != known.end()) continue;
    const std::string nearest = nearest_name(name, known);
    return "unknown option --" + printable(name) + (nearest.empty() ? "" : "; did you mean --" + nearest + "?");
  }
  return {};
}

int run_program(int argc, char** argv) {
  CLI::App app("Palpate: press a recorded block, and see which model differs from it by more than people notice",
               "palpate-demo");
  app.set_version_flag("--version", "palpate " PALPATE_VERSION);
  app.footer("Example:\n  palpate-demo --train rec.csv --test test.csv");
  Arguments arguments;
  add_options(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    const std::string unknown = unknown_option(app, argc, argv);
    return fail((unknown.empty() ? error.what() : unknown) + " (palpate-demo --help explains)", 2);
  }
  const Status status = run_demo(arguments);
  return status ? 0 : fail(status.error().message);
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  try {
    palpate::ignore_broken_pipes();
    palpate::prepare_to_fit();
    const palpate::StopListener listener;
    const int code = palpate::run_program(argc, argv);
    std::fflush(nullptr);
    std::_Exit(code);
  } catch (const std::exception& error) {
    return palpate::fail(std::string("unexpected: ") + error.what());
  }
}
