// The verbs (subcommands) of the headless program, and functions that several of them share. Each verb adds its
// subcommand and the function to run. A failed Status ends the program with one "error: ..." block on stderr and exit
// code 1. Wrong usage that CLI11 does not detect throws CLI::ValidationError, during parsing or the run: exit code 2.
// Main thread only.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/base/result.h"
#include "engine/base/signals.h"
#include "models/check/check_recording.h"
#include "models/model/fitted_model.h"
#include "scenes/scene/scene.h"

namespace palpate {
class DeviceBus;
}

namespace palpate::cli {

using Verbs = std::vector<std::pair<CLI::App*, std::function<Status()>>>;

void add_synth(CLI::App& app, Verbs& verbs);
void add_import(CLI::App& app, Verbs& verbs);
void add_check(CLI::App& app, Verbs& verbs);
void add_fit(CLI::App& app, Verbs& verbs);
void add_replay(CLI::App& app, Verbs& verbs);
void add_export(CLI::App& app, Verbs& verbs);
void add_record(CLI::App& app, Verbs& verbs);
void add_scenes(CLI::App& app, Verbs& verbs);
void add_devices(CLI::App& app, Verbs& verbs);
void add_report(CLI::App& app, Verbs& verbs);
void add_paper(CLI::App& app, Verbs& verbs);
void add_hard(CLI::App& app, Verbs& verbs);
void add_study(CLI::App& app, Verbs& verbs);

// The whole command as it was given, ready to copy, to which advice adds its options; set once by main, whose `app` has
// all verbs.
const std::string& command_line();
// The same to be kept beside a result: with the plain name of the program, without --force and --json.
const std::string& kept_command();
void set_command_line(const CLI::App& app, const std::string& program, const std::vector<std::string>& words);
// `text` with the program as it was called in every command: "palpate check" becomes "build/palpate check".
std::string with_program_name(std::string text);
// The name of a scene; another one is wrong usage.
CLI::Validator scene_name();

// The JND line of the scene, and whether its force has a memory.
CheckRequest check_request(const Scene& scene);

// Reads and checks `paths` and prints a line on stderr for each warning. Errors: a file cannot be read or is unusable.
Result<std::vector<CheckedFile>> check_before_use(const std::vector<std::string>& paths, const CheckRequest& request);

// The text of `palpate devices` about the devices on `bus`. Opens each supported one; if that fails, says why and how
// to fix it, with the udev rule in the folder `assets`.
std::string plugged_in_text(DeviceBus& bus, const std::string& assets);

// Loads a model file. Errors: as load_model; for a recording, that it is one, and `advice`.
Result<std::shared_ptr<const FittedModel>> load_model_file(const std::string& path, const std::string& advice);

bool is_folder(const std::string& path);
// `paths` with the recordings (.csv) of each folder in its place, in the order of their names. Errors: a folder that
// cannot be read or has none.
Result<std::vector<std::string>> recordings_in(const std::vector<std::string>& paths);

// One job for each recording (.csv) of a folder, as many at a time as the machine has cores, each in a process with one
// thread, so that the memory does not grow with the number of recordings. A result is complete when its file exists and
// is newer than the recording. The same command continues after an interruption; it does only what is missing. Writes
// one table with a row for each recording: what `row` reads from its result, else the reason why there is none.
struct FolderRun {
  using Row = std::vector<std::pair<std::string, nlohmann::ordered_json>>;  // column and value
  std::string label;                                                        // for the progress
  std::string folder, out;                                                  // of the recordings, of the results
  std::string result, table;  // the result of NAME.csv is out/NAME + result, the table out/table.csv
  bool force = false;         // replaces all results
  std::function<Status(const std::string& recording, const std::string& result)> job;
  std::function<Row(const std::string& result)> row;
};
// kept_command() stands in the folder. Errors: no recordings; `out` was made by another command; the recordings that
// are not done, with their reasons.
Status run_folder(const FolderRun& run);

// Errors: `out` is one of the files that are read. `option`: the option that named it, for the message.
Status refuse_input_as_output(const std::string& out, const std::vector<std::string>& inputs,
                              const std::string& option);

// Checks that an option is a finite number from `low` to `high`; CLI::Range accepts NaN.
CLI::Validator number_from(double low, double high);

// While a ProgressLine exists, the first Ctrl-C (SIGINT), SIGTERM or SIGHUP requests a stop instead of ending the
// program; the second ends it (signals.h). There may be only one at a time.
class ProgressLine {
 public:
  explicit ProgressLine(std::string label);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine();  // clears the line

  // `fraction`: the share done, 0..1; a smaller one than before is drawn as before. Returns false after an interrupt:
  // then end the job without a file.
  bool update(double fraction);

 private:
  using Clock = std::chrono::steady_clock;

  StopListener listener_;
  std::string label_;
  Clock::time_point start_;
  Clock::time_point last_drawn_;
  bool terminal_, drawn_ = false;
  double most_ = 0.0;  // of the fractions
};

// For processes of which another one shows the progress: no line is drawn any more.
void hide_progress();

// Calls `make` with the progress on stderr.
auto with_progress(std::string label, const auto& make) {
  ProgressLine line(std::move(label));
  return make(FitControl{[&](double fraction) { return line.update(fraction); }});
}

// Advice on what to press next during a recording into `path`: that of the findings of `check` on coverage and holds,
// and small strokes.
class RecordGuide {
 public:
  RecordGuide(const std::string& path, const CheckRequest& request);

  // Checks the file every two seconds, or less often so that checks take at most a tenth of the time. Returns the
  // lines to print, none when nothing has changed. `now_s`: steady clock.
  std::vector<std::string> update(double now_s);

 private:
  std::vector<std::string> advice() const;

  std::string path_;
  CheckRequest request_;
  double next_s_ = 0.0;
  std::vector<std::string> printed_;
};

// Prints to stdout. Bytes that are not UTF-8, as in paths, are replaced.
void print_json(const nlohmann::ordered_json& json);

// Prints rows of cells in aligned columns, left-aligned; with `numbers` all but the first are right-aligned.
void print_table(const std::vector<std::vector<std::string>>& rows, bool numbers);

}  // namespace palpate::cli
