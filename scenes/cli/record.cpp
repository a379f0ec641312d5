// The verbs that make recordings and check them. palpate record: motion and measured force of a real tool from a
// device. palpate synth: the virtual rig. palpate check: whether a recording is suitable for a fit.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <thread>

#include "devices/bridge/bridge_bus.h"
#include "devices/registry/device_registry.h"
#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/live/haptics_loop.h"
#include "engine/live/pacer.h"
#include "engine/recording/recording.h"
#include "models/fit/fit.h"
#include "scenes/cli/verbs.h"
#include "scenes/live/session_recorder.h"
#include "scenes/material/rig.h"

namespace palpate::cli {
namespace {

constexpr auto kPause = std::chrono::milliseconds(100);
// The program of a bridge starts within this time. Until then late reports and unconfirmed commands are normal.
constexpr double kStart_s = 1.0;
constexpr std::uint32_t kNormalAtStart = device_fault::kLate | device_fault::kWriteStalled;
// Of the guide.
constexpr double kPeriod_s = 2.0;
constexpr double kRest = 10.0;  // pause after a check, as a multiple of its duration
constexpr int kSmallStrokes = 10;
constexpr const char* kFollowed[] = {"explored", "no_hold", "short_hold"};

void print_check_text(const CheckedFile& file) {
  const std::string verdict = file.check.verdict();
  std::printf("%s: %s\n", printable(file.path, std::string::npos).c_str(),
              verdict == "care"       ? "usable with care"
              : verdict == "unusable" ? "not usable"
                                      : "usable");
  for (const Finding& finding : file.check.findings) {
    std::printf("  %-8s %-19s %s%s%s\n", severity_name(finding.severity), finding.code.c_str(), finding.text.c_str(),
                finding.advice.empty() ? "" : "; ", with_program_name(finding.advice).c_str());
  }
  if (std::ranges::count(file.check.findings, "force_noise", &Finding::code) == 0) return;
  std::printf(
      "  the noise of the force sensor alone leaves %s %% of the contact samples within the JND; this says nothing "
      "about a model\n",
      fixed(100.0 * file.check.noise_floor_within_jnd, 1).c_str());
}

void print_check_json(const std::vector<CheckedFile>& files) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const CheckedFile& file : files) {
    Json findings = Json::array();
    for (const Finding& finding : file.check.findings) {
      findings.push_back({{"code", finding.code},
                          {"severity", severity_name(finding.severity)},
                          {"value", finding.value},
                          {"text", finding.text},
                          {"advice", finding.advice}});
    }
    list.push_back({{"file", file.path},
                    {"verdict", file.check.verdict()},
                    {"findings", findings},
                    {"noise_floor_within_jnd", file.check.noise_floor_within_jnd},
                    {"surface_identified", file.check.surface_identified},
                    {"surface_offset_m", file.check.surface_offset_m},
                    {"force_zero_N", file.check.force_zero_N}});
  }
  print_json({{"recordings", list}});
}

// The output of `palpate check`; as text with the command that fits the recordings if they are usable, ready to copy.
void print_check(const std::vector<CheckedFile>& files, bool json) {
  if (json) return print_check_json(files);
  for (const CheckedFile& file : files) print_check_text(file);
  if (!refuse_unusable(files)) return;
  std::string next = "next: palpate fit --recording";
  for (const CheckedFile& file : files) next += " " + shell_word(file.path);
  std::printf("%s --out model.json\n", with_program_name(next).c_str());
}

struct RecordOptions {
  std::string device, out, scene = "silicone_block";
  double seconds = 0.0;  // 0: until Ctrl-C
  bool guide = false, json = false, force = false, bridge_remote = false;
};

// Shows the recording on stderr: on a terminal a status line that is overwritten, and each problem as a separate line.
class RecordProgress {
 public:
  explicit RecordProgress(bool measures_force) : measures_force_(measures_force) {}
  ~RecordProgress() { clear(); }

  // `normal`: faults that are not to be shown.
  void show(const LoopSnapshot& snapshot, const RecordingStatus& status, std::uint32_t normal) {
    const std::uint32_t faults = snapshot.device_faults_latched & ~normal;
    for (const std::string& words : device_fault_words(faults & ~shown_faults_)) line("device: " + words);
    shown_faults_ |= faults;
    if (!terminal_) return;
    const double step_s = snapshot.tick.time_s - last_s_;
    const double speed_m_per_s = step_s > 0.0 ? (snapshot.tick.position_m - last_m_) / step_s : 0.0;
    last_s_ = snapshot.tick.time_s;
    last_m_ = snapshot.tick.position_m;
    const double rate_Hz = snapshot.device.interval_s > 0.0 ? 1.0 / snapshot.device.interval_s : 0.0;
    std::string text = fixed(status.seconds, 1) + " s, " + std::to_string(status.rows) + " rows";
    if (rate_Hz > 0.0) text += ", " + fixed(rate_Hz, 0) + " a second";
    text += "   depth " + fixed(1e3 * snapshot.tick.position_m, 2) + " mm   speed " + fixed(1e3 * speed_m_per_s, 0) +
            " mm/s";
    if (measures_force_) text += "   force " + fixed(snapshot.measured_N, 3) + " N";
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    drawn_ = true;
  }
  void line(const std::string& text) {
    clear();
    std::fprintf(stderr, "%s\n", text.c_str());
  }

 private:
  void clear() {
    if (drawn_) std::fputs("\r\033[K", stderr);
    drawn_ = false;
  }

  bool measures_force_;
  bool terminal_ = isatty(STDERR_FILENO) == 1;
  bool drawn_ = false;
  std::uint32_t shown_faults_ = 0;
  double last_s_ = 0.0, last_m_ = 0.0;
};

// If the device needs zeroing, waits without blocking for Enter, which says that the tool is at its rest position.
void zero_on_enter(Device& device, const DeviceHealth& health, bool& announced, RecordProgress& progress) {
  if (health.zeroing != Zeroing::needed) {
    announced = false;
    return;
  }
  if (!announced) progress.line(zeroing_words(health) + " (press Enter)");
  announced = true;
  pollfd input{STDIN_FILENO, POLLIN, 0};
  char typed[256];
  if (poll(&input, 1, 0) == 1 && ::read(STDIN_FILENO, typed, sizeof typed) > 0) device.start_zeroing();
}

RecorderRequest recorder_request(const RecordOptions& options, Device& device) {
  const SensorSpec sensor = device.sensor();
  return {options.out,
          ReferenceKind::measured,
          {sensor.has_velocity, sensor.has_acceleration, device.measures_force()},
          {"recorded by palpate record; device " + options.device,
           "position_m: as the device gave it; " +
               std::string(device.measures_force() ? "force_N: as it measured it" : "it measures no force")},
          options.force};
}

// Records until the time is over or the user stops it.
Result<std::string> record(const RecordOptions& options, const CheckRequest& check, Device& device) {
  HapticsLoop loop(device);
  SessionRecorder recorder(loop);
  RecordProgress progress(device.measures_force());
  if (const std::string note = device.note(); !note.empty()) progress.line(note);
  if (const Status status = loop.start(); !status) return status.error();
  if (const Status status = recorder.start(recorder_request(options, device)); !status) return status.error();
  LoopControls controls;
  controls.recording = recorder.number();
  loop.set_controls(controls);
  RecordGuide guide(options.out, check);
  bool zeroing_announced = false;
  std::optional<Notice> outcome;
  for (const double start_s = steady_now_s(); !outcome && stop_requested() == 0;) {
    std::this_thread::sleep_for(kPause);
    const LoopSnapshot newest = loop.newest();
    progress.show(newest, recorder.status(), controls.acknowledged == 0 ? kNormalAtStart : 0);
    const bool on_time = newest.device.interval_s > 0.0 && (newest.device.faults & kNormalAtStart) == 0;
    if (on_time || steady_now_s() - start_s > kStart_s) controls.acknowledged = 1;  // clears the latched faults
    loop.set_controls(controls);
    zero_on_enter(device, loop.newest().device, zeroing_announced, progress);
    if (options.guide) {
      for (const std::string& line : guide.update(steady_now_s())) progress.line(line);
    }
    if (options.seconds > 0.0 && steady_now_s() - start_s >= options.seconds) break;
    outcome = recorder.read_outcome();
  }
  recorder.stop();
  recorder.wait();
  loop.stop();
  if (!outcome) outcome = recorder.read_outcome();
  if (outcome->problem) return Error{outcome->text};
  return outcome->text;
}

Status run_record(const RecordOptions& options) {
  const StopListener listener;
  const auto scene = load_scene(options.scene);
  if (!scene) return scene.error();
  if (options.bridge_remote) allow_remote_bridges();
  auto device = open_device(options.device, {.calibrations = calibrations_folder()});
  if (!device && device.error().message.starts_with("unknown device"))
    throw CLI::ValidationError("--device", device.error().message);
  if (!device) return device.error();
  if (options.guide && !(*device)->measures_force()) {
    return Error{"--guide: " + options.device +
                 " measures no force, so the surface cannot be found; leave --guide out"};
  }
  const Result<std::string> recorded = record(options, check_request(*scene), **device);
  (*device)->close();
  if (!recorded) return recorded.error();
  std::fprintf(options.json ? stderr : stdout, "%s\n", recorded->c_str());
  if (!(*device)->measures_force()) {
    if (options.json) {
      print_check({}, true);
    } else {
      std::printf("%s has no force: before a fit, add a column force_N with the force of a sensor\n",
                  options.out.c_str());
    }
    return {};
  }
  const auto file = check_recording_file(options.out, check_request(*scene));
  if (!file) return file.error();
  print_check({*file}, options.json);
  return {};
}

}  // namespace

RecordGuide::RecordGuide(const std::string& path, const CheckRequest& request)
    : path_(AtomicFile::part_of(path)), request_(request) {}

std::vector<std::string> RecordGuide::advice() const {
  const auto file = check_recording_file(path_, request_);
  if (!file || file->check.measures.contact_rows == 0) return {"next: touch the block, then press it slowly"};
  std::vector<std::string> lines;
  for (const Finding& finding : file->check.findings) {
    const bool followed = std::ranges::find(kFollowed, finding.code) != std::end(kFollowed);
    if (followed && !finding.advice.empty()) lines.push_back(finding.advice);
  }
  if (file->check.measures.small_strokes < kSmallStrokes)
    lines.emplace_back("make small strokes: stay in the block and move a little in and out");
  if (lines.empty()) lines.emplace_back("nothing is missing: Ctrl-C ends the recording");
  return lines;
}

std::vector<std::string> RecordGuide::update(double now_s) {
  if (now_s < next_s_) return {};
  const double start_s = steady_now_s();
  std::vector<std::string> lines = advice();
  next_s_ = now_s + std::max(kPeriod_s, kRest * (steady_now_s() - start_s));
  return std::exchange(printed_, lines) == lines ? std::vector<std::string>{} : lines;
}

void add_record(CLI::App& app, Verbs& verbs) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* verb = app.add_subcommand("record", "Record motion and measured force of a tool, until Ctrl-C");
  verb->add_option("--device", options->device, "Name of the device; palpate devices lists the names")
      ->required()
      ->type_name("NAME");
  verb->add_option("--out", options->out, "Recording to write (CSV)")->required()->type_name("REC.csv");
  verb->add_option("--seconds", options->seconds, "Length of the recording in s [until Ctrl-C]")
      ->check(number_from(0.1, 1e6));
  verb->add_flag("--guide", options->guide, "Say what to press next, and show which depths and speeds are missing");
  verb->add_option("--scene", options->scene, "Scene that gives the JND line, and whether the force has a memory")
      ->capture_default_str()
      ->check(scene_name());
  verb->add_flag("--bridge-remote", options->bridge_remote, "Allow bridge:tcp: to name another computer");
  verb->add_flag("--json", options->json, "Print one JSON object, that of palpate check");
  verb->add_flag("--force", options->force, "Replace an existing file");
  verbs.emplace_back(verb, [options] { return run_record(*options); });
}

namespace {

struct CheckOptions {
  std::vector<std::string> recordings;
  std::string scene = "silicone_block";
  bool json = false;
};

Status run_check(const CheckOptions& options) {
  const auto scene = load_scene(options.scene);
  if (!scene) return scene.error();
  const auto files = check_recording_files(options.recordings, check_request(*scene));
  if (!files) return files.error();
  print_check(*files, options.json);
  // The findings are printed already.
  for (const CheckedFile& file : *files) {
    if (refuse_unusable({file})) continue;
    std::vector<std::string> codes;
    for (const Finding& finding : file.check.findings)
      if (finding.severity == Severity::fatal) codes.push_back(finding.code);
    return Error{file.path + ": not usable for a fit: " + joined(codes) + "; follow the advice above"};
  }
  return {};
}

struct SynthOptions {
  RigSettings rig;
  std::string out;
  bool force = false;
};

// Checks the command line before any work.
void check_usage(const CLI::App& verb, const SynthOptions& options) {
  if (verb.count("--seconds") > 0 && !(options.rig.seconds > 0.0))
    throw CLI::ValidationError("--seconds", "must be a number above 0");
  const Result<Rig> trial = Rig::create(options.rig);
  if (!trial) throw CLI::ValidationError("synth", trial.error().message);
}

void list_materials() {
  for (const Material& material : materials()) {
    std::cout << std::left << std::setw(9) << material.name << " " << material.summary
              << " (relaxation times: " << material.relaxation_times << ")\n";
  }
  throw CLI::Success();
}

Status run_synth(const SynthOptions& options) {
  const Result<Material> material = find_material(options.rig.material);
  if (!material) return material.error();
  const Result<Recording> recording =
      with_progress("recording " + options.rig.material,
                    [&](const FitControl& control) { return record_sensors(options.rig, control.progress); });
  if (!recording) return recording.error();
  const Status written = write_recording(
      options.out, *recording, describe_recording(options.rig, *material, recording->rows.size()), options.force);
  if (!written) return written;
  std::cout << "written  " << printable(options.out, std::string::npos) << ": " << recording->rows.size() << " rows, "
            << general(recording->rows.back().time_s - recording->rows.front().time_s, 6) << " s\n";
  return {};
}

}  // namespace

void add_synth(CLI::App& app, Verbs& verbs) {
  auto options = std::make_shared<SynthOptions>();
  CLI::App* verb = app.add_subcommand("synth", "Make a recording in which a virtual hand presses a virtual material");
  verb->add_option("--material", options->rig.material, "Material to press; --list prints the names")->required();
  verb->add_option("--seed", options->rig.seed, "Seed of the hand motion and the sensor noise")
      ->check(CLI::Validator([](const std::string& text) { return option_error("seed", text); }, ""))
      ->capture_default_str();
  verb->add_option("--seconds", options->rig.seconds, "Length in s [depends on the material]")
      ->check(number_from(0.1, 1e6));
  verb->add_option("--rate", options->rig.rate_Hz, "Rows per second (Hz), 10 to 20000")
      ->check(number_from(10.0, 20000.0))
      ->capture_default_str();
  verb->add_option("--out", options->out, "Recording to write (CSV)")->required();
  verb->add_flag("--force", options->force, "Replace an existing file");
  verb->add_flag_callback("--list", list_materials, "Print the materials and their relaxation times");
  verb->parse_complete_callback([verb, options] { check_usage(*verb, *options); });
  verbs.emplace_back(verb, [options] { return run_synth(*options); });
}

void add_check(CLI::App& app, Verbs& verbs) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = app.add_subcommand("check", "Check whether recordings are suitable for a fit");
  verb->add_option("recording", options->recordings, "Recordings to check (CSV)")->required()->type_name("REC.csv");
  verb->add_option("--scene", options->scene, "Scene that gives the JND line, and whether the force has a memory")
      ->capture_default_str()
      ->check(scene_name());
  verb->add_flag("--json", options->json, "Print one JSON object");
  verbs.emplace_back(verb, [options] { return run_check(*options); });
}

}  // namespace palpate::cli
