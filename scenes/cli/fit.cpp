// palpate fit: fits a model to recordings and writes its file. palpate export: writes a model as one self-contained C99
// file.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <optional>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/live/pacer.h"
#include "engine/tick/haptics_tick.h"
#include "models/export/export_c.h"
#include "models/fit/fit.h"
#include "models/model/file/model_io.h"
#include "scenes/cli/verbs.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/report/report.h"

namespace palpate::cli {
namespace {

struct FitArguments {
  std::vector<std::string> recordings;
  std::vector<OptionText> options;
  ModelPlan plan;
  std::string scene = "silicone_block", out;
  bool force = false, json = false;
};

void list_methods() {
  for (const ModelPlan& plan : all_plans()) std::cout << family_name(plan) << "\n";
  throw CLI::Success();
}

// An option of plan_options(), whose text goes to `arguments`.
void add_plan_option(CLI::App& verb, const PlanOption& option, const std::shared_ptr<FitArguments>& arguments) {
  std::string help = option.help;
  if (option.takes != 0) help += ", for " + family_names(option.takes);
  const auto check = [name = option.name](const std::string& text) { return option_error(name, text); };
  const auto keep = [name = option.name, arguments](const std::string& text) {
    arguments->options.push_back({name, text});
  };
  verb.add_option_function<std::string>("--" + option.name, keep, help)
      ->check(CLI::Validator(check, ""))
      ->type_name(option.values)
      ->default_str(option.default_text);
}

// Reads the options together: some exclude each other, or need another method.
void read_plan(FitArguments& arguments) {
  auto plan = plan_of(arguments.options);
  if (!plan) throw CLI::ValidationError("--" + plan.error().message);
  arguments.plan = std::move(*plan);
}

// Replays the training recordings as recorded, and reports where their share within the JND contradicts that of the
// fit.
std::string training_contradiction(const std::vector<CheckedFile>& files,
                                   const std::shared_ptr<const FittedModel>& model) {
  ErrorFigures errors;
  for (const CheckedFile& file : files) {
    if (file.prepared->stride > 1) return {};  // rows are missing
    replay(file.recording(), {model}, [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
      if (snapshot.in_contact) errors.add(snapshot.force_N[0], row.force_N, false, model->data().jnd);
    });
  }
  const double printed = model->data().provenance.training_within_jnd;
  if (!(std::abs(errors.within_jnd() - printed) > kLeastShare)) return {};
  return "in training, " + fixed(100.0 * errors.within_jnd(), 2) + " % within one JND as recorded, " +
         fixed(100.0 * printed, 2) + " % beyond the surface, with the zeros corrected";
}

void print_line(const char* label, const std::string& text) {
  std::printf("%-17s %s\n", label, printable(text, std::string::npos).c_str());
}

std::string correction_text(const CorrectionChoice& choice) {
  if (!choice.used) return "none: it does not lower the cross-validated error, so the model is the trend alone";
  return "cross-validated error " + fixed(choice.error_over_jnd, 3) + " JND, trend alone " +
         fixed(choice.trend_error_over_jnd, 3) + " JND";
}

std::string surface_text(const RecordingOffset& surface) {
  return surface.name + " at " + fixed(1e3 * surface.offset_m, 3) +
         (std::isfinite(surface.standard_error_m) ? " +- " + fixed(1e3 * surface.standard_error_m, 3) + " mm"
                                                  : std::string(" mm (not identified)")) +
         ", force zero " + fixed(1e3 * surface.force_zero_N, 1) + " mN";
}

// "fast 0.002-0.02 s, middle 0.0356-0.356 s, slow 0.632-11.2 s"; names only where there are three; empty without
// memory.
std::string relaxation_bands(const std::vector<FeatureSpec>& features) {
  std::vector<std::string> bands;
  for (const FeatureSpec& feature : features) {
    const std::vector<double> times_s = relaxation_times_s({feature});
    if (times_s.empty()) continue;
    const auto [first, last] = std::ranges::minmax_element(times_s);
    bands.push_back(general(*first, 3) + (*first < *last ? "-" + general(*last, 3) : "") + " s");
  }
  constexpr const char* kNames[] = {"fast ", "middle ", "slow "};
  for (std::size_t i = 0; i < bands.size() && bands.size() == std::size(kNames); ++i) bands[i] = kNames[i] + bands[i];
  return joined(bands);
}

void print_fit(const PreparedTraining& prepared, const MethodFit& fit, double seconds, bool accelerometer,
               const FitArguments& arguments) {
  const ModelData& data = fit.model->data();
  const Provenance& provenance = data.provenance;
  if (!prepared.gains.empty()) {
    print_table(table_text(gains_table(prepared.gains)), true);
    std::printf(
        "errors with all terms, and with all but this one (of depth-dependent relaxation: with the best, with none);\n"
        "used: with a weight above 0, or selected, not by these errors alone; the names give the range of the times\n"
        "tried, the line below that of the times used\n\n");
  }
  print_line("model", data.name + ", fitted in " + fixed(seconds, 2) + " s");
  if (const RbfFunction* const rbf = rbf_of(data.correction); rbf != nullptr && fit.rank > 0) {
    print_line("centres", std::to_string(rbf->centre_count()) + ", rank " + std::to_string(fit.rank) + " of " +
                              std::to_string(rbf->centre_count() + rbf->tail.size()) + " columns");
  }
  print_line("samples", std::to_string(provenance.samples) + ", " + std::to_string(provenance.contact_samples) +
                            " in contact, " + std::to_string(provenance.samples_after_reduction) + " after thinning");
  for (const RecordingOffset& surface : provenance.offsets) print_line("surface", surface_text(surface));
  // The depth is the first feature.
  if (const double begins_m = data.features.front().surface_position_m; begins_m != 0.0)
    print_line("depth starts", "at " + fixed(1e3 * begins_m, 3) + " mm, where the force of the recordings begins");
  if (const std::string bands = relaxation_bands(data.features); !bands.empty()) print_line("relaxation times", bands);
  if (prepared.correction) print_line("correction", correction_text(*prepared.correction));
  for (const std::string& note : fit.notes)
    print_line(
        fit.choices && note.starts_with(choices_text(*fit.choices, fit.kernel.has_value())) ? "selected" : "note",
        note);
  for (const OptionText& option : arguments.options)
    if (arguments.plan.features == FeatureChoice::given && option.name == "features" &&
        ("," + option.value + ",").find(",depth,") == std::string::npos)
      print_line("note", "depth is always included");
  print_line("training <= JND", fixed(100.0 * provenance.training_within_jnd, 2) + " %" +
                                    (accelerometer ? " (with the accelerometer)" : " (from positions alone)"));
  print_line("written", arguments.out);
  print_line("next", with_program_name("palpate replay --recording TEST.csv --model ") + shell_word(arguments.out));
  std::string train;
  for (const std::string& one : arguments.recordings) train += " " + shell_word(one);
  print_line("best method", "not determined without a test; this compares all by one rule: " +
                                with_program_name("palpate report --train" + train + " --test TEST.csv --out DIR"));
}

Status run_fit(const FitArguments& arguments) {
  std::vector<std::string> inputs = arguments.recordings;
  inputs.push_back(arguments.scene);
  if (const Status status = refuse_input_as_output(arguments.out, inputs, "--out"); !status) return status;
  const auto scene = load_scene(arguments.scene);
  if (!scene) return scene.error();
  // Reports before the fit if the output cannot be written.
  if (const auto trial = AtomicFile::create(arguments.out, arguments.force); !trial) return trial.error();
  const double began_s = steady_now_s();
  std::optional<ProgressLine> line("fitting " + plan_name(arguments.plan));
  auto checked = check_before_use(arguments.recordings, check_request(*scene));
  if (!checked) return checked.error();
  // An accelerometer reduces the training error, and a device may have none.
  const bool accelerometer =
      std::ranges::any_of(*checked, [](const CheckedFile& one) { return one.recording().columns.acceleration; });
  ModelFits fits(training_recordings(*checked), training_scene(*scene));
  const auto fitted = fits.fit(arguments.plan, {[&](double fraction) { return line->update(fraction); }});
  if (!fitted) return fitted.error();
  const double seconds = steady_now_s() - began_s;
  const std::string contradiction = training_contradiction(*checked, fitted->model);
  if (Status status = save_model(arguments.out, fitted->model->data(), arguments.force); !status) return status;
  line.reset();  // ends the progress line
  if (!contradiction.empty()) std::cerr << "note: " << printable(contradiction, std::string::npos) << "\n";
  if (arguments.json) {
    print_json(fit_json(*fitted, seconds));
  } else {
    print_fit(**fits.prepare(arguments.plan, {}), *fitted, seconds, accelerometer, arguments);
  }
  return {};
}

// A model for each recording of a folder.
Status fit_each(const FitArguments& arguments) {
  const std::string& folder = arguments.recordings.front();
  const auto job = [&](const std::string& recording, const std::string& result) {
    FitArguments one = arguments;
    one.recordings = {recording};
    one.out = result;
    one.force = true;
    return run_fit(one);
  };
  const auto row = [](const std::string& result) -> FolderRun::Row {
    const auto model = load_model(result);
    if (!model) return {};
    const Provenance& provenance = (*model)->data().provenance;
    return {{"model", (*model)->name()},
            {"samples", provenance.samples},
            {"contact_samples", provenance.contact_samples},
            {"training_within_jnd", provenance.training_within_jnd}};
  };
  return run_folder(
      {"fitting " + plan_name(arguments.plan), folder, arguments.out, ".json", "models", arguments.force, job, row});
}

// With one folder and `--out FOLDER` each recording gets its own model; else all recordings are one training set.
Status run_fit_or_each(FitArguments arguments) {
  const bool to_file = std::filesystem::path(arguments.out).extension() == ".json";
  if (arguments.recordings.size() == 1 && is_folder(arguments.recordings.front()) && !to_file)
    return fit_each(arguments);
  auto recordings = recordings_in(arguments.recordings);
  if (!recordings) return recordings.error();
  arguments.recordings = std::move(*recordings);
  return run_fit(arguments);
}

}  // namespace

void add_fit(CLI::App& app, Verbs& verbs) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::App* verb = app.add_subcommand("fit", "Fit a force model to recordings");
  verb->add_option("--recording", arguments->recordings,
                   "Training recordings (CSV) or folders of them; together they form one training set. With one folder "
                   "and --out FOLDER each recording gets its own model, in parallel; the same command continues a run")
      ->required()
      ->type_name("CSV|FOLDER");
  for (const PlanOption& option : plan_options()) add_plan_option(*verb, option, arguments);
  verb->add_flag_callback("--list-methods", list_methods, "Print the names of all methods, one per line");
  verb->option_defaults()->always_capture_default();
  verb->add_option("--scene", arguments->scene, "Scene that gives the features and the JND line")->check(scene_name());
  verb->add_option("--out", arguments->out, "Model file (JSON) or folder to write")
      ->required()
      ->type_name("JSON|FOLDER");
  verb->add_flag("--force", arguments->force, "Replace an existing file");
  verb->add_flag("--json", arguments->json, "Print one JSON object");
  verb->parse_complete_callback([arguments] { read_plan(*arguments); });
  verbs.emplace_back(verb, [arguments] { return run_fit_or_each(*arguments); });
}

namespace {

struct ExportArguments {
  std::string model, out;
  double encoder_step_m = 0.0;
  bool single_precision = false, force = false;
};

void print_summary(const ExportArguments& arguments, const ModelData& data, const SensorSpec& sensor,
                   std::size_t bytes) {
  std::printf("%s: %s in %s precision, %zu bytes of C\n", arguments.out.c_str(), data.name.c_str(),
              arguments.single_precision ? "single" : "double", bytes);
  std::printf(
      "expects positions in steps of %g um with an additional noise of %g um (%s);\n"
      "gives the forces of palpate replay without an accelerometer\n",
      1e6 * sensor.encoder_step_m, 1e6 * sensor.position_noise_m,
      arguments.encoder_step_m > 0.0 ? "from --encoder-step"
      : data.sensor                  ? "from the model's recordings"
                                     : "the model has no step of its recordings; see --encoder-step");
}

Status run_export(const ExportArguments& arguments) {
  if (const Status status = refuse_input_as_output(arguments.out, {arguments.model}, "--c"); !status) return status;
  const auto model = load_model_file(
      arguments.model, "fit a model: palpate fit --recording " + shell_word(arguments.model) + " --out model.json");
  if (!model) return model.error();
  const ModelData& data = (*model)->data();
  const SensorSpec sensor = sensor_with_step(data, arguments.encoder_step_m);
  const std::string text = export_c(data, sensor, arguments.single_precision);
  if (Status status = write_file_atomically(arguments.out, text, arguments.force); !status) return status;
  print_summary(arguments, data, sensor, text.size());
  return {};
}

}  // namespace

void add_export(CLI::App& app, Verbs& verbs) {
  CLI::App* command = app.add_subcommand("export", "Write a model as one self-contained C99 file");
  const auto arguments = std::make_shared<ExportArguments>();
  command->add_option("model", arguments->model, "Model file (JSON)")->required();
  command->add_option("--c", arguments->out, "C file to write")->required();
  command->add_flag("--float", arguments->single_precision, "Compute in single precision [double]");
  command
      ->add_option("--encoder-step", arguments->encoder_step_m,
                   "Step of the positions in metres; 0: the step of the model's recordings")
      ->check(number_from(0.0, 0.1))
      ->capture_default_str();
  command->add_flag("--force", arguments->force, "Replace an existing file");
  verbs.emplace_back(command, [arguments] { return run_export(*arguments); });
}

}  // namespace palpate::cli
