// palpate synth: writes a recording made by the virtual rig.
#include <iomanip>
#include <iostream>
#include <memory>
#include <string>

#include "engine/base/text.h"
#include "engine/recording/recording.h"
#include "models/fit/fit.h"
#include "scenes/cli/verbs.h"
#include "scenes/material/rig.h"

namespace palpate::cli {
namespace {

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

}  // namespace palpate::cli
