// palpate fit: recordings in, a model file out.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "engine/base/atomic_file.h"
#include "engine/base/text.h"
#include "engine/tick/replay.h"
#include "models/fit/fit.h"
#include "models/fit/recipe_2009.h"
#include "models/model/file/model_io.h"
#include "models/model/fitted_model.h"
#include "models/recordings/recording_faults.h"
#include "scenes/cli/check_recordings.h"
#include "scenes/cli/feature_list.h"
#include "scenes/cli/fit_output.h"
#include "scenes/cli/progress.h"
#include "scenes/cli/verbs.h"
#include "scenes/evaluation/error_figures.h"
#include "scenes/scene/scene.h"
#include "scenes/scene/training.h"

namespace palpate::cli {
namespace {

// A training figure that a replay contradicts by more is explained.
constexpr double kContradiction = 0.005;

struct FitArguments {
  std::vector<std::string> recordings;
  std::string method;
  int centres = 100;
  std::string candidates = "100";
  std::string kernel = "cubic";
  std::string weighting = "jnd";
  std::string reduction = "coverage";
  std::string features = "auto";
  std::string relaxation;  // empty: not given
  std::string surface = "auto";
  std::string grid;
  std::string scene = "silicone_block";
  std::uint64_t seed = 1;
  std::string out;
  bool force = false;
  bool json = false;
  bool list_methods = false;
};

// Choosing centres takes a time that grows with their square, half a minute at this many; a
// model of more is hardly smaller than that of `direct`, which has them all.
constexpr int kMostCentres = 2000;

// An option that only some methods take.
struct MethodOnly {
  const char* option;
  MethodOption takes;
};
constexpr MethodOnly kMethodOnly[] = {{"--centres", kTakesCentres},
                                      {"--candidates", kTakesCandidates},
                                      {"--grid", kTakesGrid},
                                      {"--kernel", kTakesKernel}};

// "25x11x11x11" as whole numbers of at least 2; empty when it is anything else.
std::vector<int> parse_grid(const std::string& text) {
  std::vector<int> sizes;
  for (const double value : parse_values(text, 'x')) {
    if (value < 2.0 || value > 1e6 || value != std::floor(value)) return {};
    sizes.push_back(static_cast<int>(value));
  }
  return sizes;
}

std::string check_candidates(const std::string& text) {
  int value = 0;
  const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc() && next == text.data() + text.size() && value >= 1;
  return number || text == "all" ? "" : "found \"" + text + "\", expected a whole number of at least 1, or all";
}

std::string check_relaxation(const std::string& text) {
  if (text == "scene" || text == "auto") return "";
  const std::size_t count = parse_values(text, ',').size();
  if (count >= 1 && count <= 6) return "";
  return "found \"" + text + "\", expected scene, auto, or one to six times in seconds such as 0.17,1.27";
}

std::string check_grid(const std::string& text) {
  return parse_grid(text).empty() ? "found \"" + text + "\", expected sizes such as 25x11x11x11" : "";
}

template <typename Names>
std::size_t index_of(const Names& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

TrainingRequest training_request(const FitArguments& arguments, const Scene& scene) {
  TrainingRequest request = palpate::training_request(scene);
  request.weighting = static_cast<Weighting>(index_of(kWeightingNames, arguments.weighting));
  request.reduction = static_cast<Reduction>(index_of(kReductionNames, arguments.reduction));
  request.surface = arguments.surface == "recorded" ? Surface::recorded : Surface::automatic;
  // Relaxation times that are asked for are those of the scene's features, and the
  // paper's own recipe has the scene's low-pass features.
  const bool papers = request.reduction == Reduction::force && request.weighting == Weighting::relative;
  if (!arguments.relaxation.empty() || papers || arguments.features == "scene") {
    request.choice = FeatureChoice::scene;
  } else if (arguments.features == "auto") {
    request.choice = FeatureChoice::automatic;
  } else {
    request.choice = FeatureChoice::given;
    request.list = *parse_feature_list(arguments.features);
  }
  // Its two times are fitted, unless others are asked for.
  if (papers && arguments.relaxation.empty()) return recipe_2009_request(request);
  if (arguments.relaxation == "auto") {
    request.relaxation = Relaxation::automatic;
  } else if (!arguments.relaxation.empty() && arguments.relaxation != "scene") {
    request.relaxation = Relaxation::given;
    request.relaxation_times_s = parse_values(arguments.relaxation, ',');
  }
  return request;
}

MethodRequest method_request(const FitArguments& arguments) {
  MethodRequest request;
  request.method = find_method(arguments.method);
  request.centres = arguments.centres;
  request.candidates = arguments.candidates == "all" ? 0 : std::stoi(arguments.candidates);
  request.kernel = *kernel_from_name(arguments.kernel);
  request.grid = parse_grid(arguments.grid);
  request.seed = arguments.seed;
  return request;
}

// An error in training is smaller where an accelerometer helped, and a device may have none.
std::string sensor_text(const std::vector<CheckedFile>& files) {
  const bool any = std::any_of(files.begin(), files.end(),
                               [](const CheckedFile& one) { return one.recording.columns.acceleration; });
  return any ? " (with the accelerometer)" : " (from positions alone)";
}

// Wrong usage that CLI11 cannot see: what is missing unless the methods are only
// listed, and an option that the method has no use for.
void check_usage(const CLI::App& verb, const FitArguments& arguments) {
  if (arguments.list_methods) return;
  for (const char* needed : {"--recording", "--method", "--out"}) {
    if (verb.count(needed) == 0) throw CLI::RequiredError(needed);
  }
  if (verb.count("--relaxation") > 0 && verb.count("--features") > 0 && arguments.features != "scene") {
    throw CLI::ValidationError("--relaxation", "these are times of the scene's features, and --features asks for \"" +
                                                   arguments.features + "\"; leave one of the two out");
  }
  const Method& method = *find_method(arguments.method);
  for (const MethodOnly& only : kMethodOnly) {
    if (verb.count(only.option) == 0 || method.can_take(only.takes)) continue;
    throw CLI::ValidationError(only.option, std::string("not taken by method ") + method.name + ", only by " +
                                                methods_that_take(only.takes) + "; leave it out");
  }
}

Status list_methods() {
  for (const Method* method : methods()) std::cout << method->name << "\n";
  return {};
}

// Replays the training recordings as they came, and says where that contradicts the
// share that the fit printed for itself.
std::string training_contradiction(const std::vector<std::string>& recordings, const ModelData& data) {
  const auto model = std::make_shared<const FittedModel>(data);
  ErrorFigures errors;
  for (const std::string& path : recordings) {
    const auto recording = read_usable_recording(path, kMostCheckedRows);
    if (!recording) return {};
    const auto replayed =
        replay(*recording, {model}, [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) {
          if (snapshot.in_contact) errors.add(snapshot.force_N[0], row.force_N, false, data.jnd);
        });
    if (!replayed) return {};
  }
  const double as_recorded = errors.within_jnd();
  const double printed = data.provenance.training_within_jnd;
  if (!(std::abs(as_recorded - printed) > kContradiction)) return {};
  const auto& surfaces = data.provenance.surfaces;
  const bool changed = std::any_of(surfaces.begin(), surfaces.end(), [](const RecordingSurface& one) {
    return one.offset_m != 0.0 || one.force_zero_N != 0.0 || one.lag_s != 0.0;
  });
  return "replayed as recorded, the training recordings have " + fixed(100.0 * as_recorded, 2) + " % within the JND, " +
         fixed(100.0 * printed, 2) + " % " +
         (changed ? "with the surfaces, force zeros and lags above taken off"
                  : "at positions where the model has its material; the rest are forces outside of it");
}

Status run_fit(const FitArguments& arguments) {
  if (arguments.list_methods) return list_methods();
  const auto scene = load_scene(arguments.scene);
  if (!scene) return scene.error();
  // A name that cannot be written is told now and not after the fit.
  if (const auto trial = AtomicFile::create(arguments.out, arguments.force); !trial) return trial.error();
  const auto start = std::chrono::steady_clock::now();
  std::optional<ProgressLine> line("fitting " + arguments.method);
  FitControl prepare;
  prepare.progress = [&](double fraction) { return line->update(fraction); };
  FitControl method;
  method.progress = [&](double fraction) { return line->update(0.3 + 0.7 * fraction); };

  auto checked = check_before_use(arguments.recordings, check_request(*scene));
  if (!checked) return checked.error();
  const std::string sensor = sensor_text(*checked);
  MotionSource source(training_inputs(std::move(*checked)));
  const TrainingRequest training = training_request(arguments, *scene);
  const auto prepared = prepare_training(source, training, prepare);
  if (!prepared) return prepared.error();
  MethodRequest asked = method_request(arguments);
  // Asked for before anybody knows the features: the last size serves all that have none.
  if (training.choice == FeatureChoice::automatic && !asked.grid.empty())
    asked.grid.resize(prepared->common.features.size(), asked.grid.back());
  const auto fit = fit_method(*prepared, asked, method);
  if (!fit) return fit.error();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string contradiction = training_contradiction(arguments.recordings, fit->data);
  if (Status status = save_model(arguments.out, fit->data, arguments.force); !status) return status;
  line.reset();  // what follows goes onto a line of its own
  if (!contradiction.empty()) std::cerr << "note: " << contradiction << "\n";
  if (arguments.json) {
    print_fit_json(*fit, arguments.kernel, arguments.weighting, seconds);
  } else {
    print_fit(*fit, *prepared, seconds, sensor, arguments.out);
  }
  return {};
}

}  // namespace

void add_fit(CLI::App& app, Verbs& verbs) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::App* verb = app.add_subcommand("fit", "Fit a force model to recordings");
  verb->add_option("--recording", arguments->recordings, "Training recordings; together one training set")
      ->type_name("CSV");
  std::vector<std::string> names;
  for (const Method* method : methods()) names.emplace_back(method->name);
  verb->add_option("--method", arguments->method, "One of " + method_names())->check(CLI::IsMember(names));
  verb->add_flag("--list-methods", arguments->list_methods, "Name the methods, one to a line");
  verb->add_option("--centres", arguments->centres,
                   "Centres of " + methods_that_take(kTakesCentres) + "; for every site there is direct")
      ->check(CLI::Range(1, kMostCentres))
      ->capture_default_str();
  verb->add_option("--candidates", arguments->candidates,
                   "Sites tried per step, or all, of " + methods_that_take(kTakesCandidates))
      ->check(CLI::Validator(check_candidates, "N|all"))
      ->capture_default_str();
  verb->add_option("--kernel", arguments->kernel, "The radial function")
      ->check(CLI::IsMember(kernel_names()))
      ->capture_default_str();
  verb->add_option("--weighting", arguments->weighting, "What an error counts: 1/JND, the paper's 1/f, or 1")
      ->check(CLI::IsMember({"jnd", "relative", "none"}))
      ->capture_default_str();
  verb->add_option("--reduction", arguments->reduction,
                   "Which samples become sites: feature space covered, the paper's 50 mN steps, or all")
      ->check(CLI::IsMember({"coverage", "force", "none"}))
      ->capture_default_str();
  verb->add_option("--features", arguments->features,
                   std::string("What the force may depend on: what the recordings support, the scene's features, or a "
                               "list such as ") +
                       kFeatureListExample)
      ->check(CLI::Validator(check_features, "auto|scene|LIST"))
      ->capture_default_str();
  verb->add_option("--relaxation", arguments->relaxation,
                   "The scene's features with its relaxation times, identified ones, or these")
      ->check(CLI::Validator(check_relaxation, "scene|auto|S,S"));
  verb->add_option("--surface", arguments->surface, "Where each recording's surface is: found, or at 0 as recorded")
      ->check(CLI::IsMember({"auto", "recorded"}))
      ->capture_default_str();
  verb->add_option("--grid", arguments->grid,
                   "Nodes of the grid per feature [25x11x11x11], of " + methods_that_take(kTakesGrid))
      ->check(CLI::Validator(check_grid, "NxN"));
  verb->add_option("--scene", arguments->scene, "Scene whose features and JND line count")->capture_default_str();
  verb->add_option("--seed", arguments->seed, "Of " + methods_that_take(kTakesSeed))->capture_default_str();
  verb->add_option("--out", arguments->out, "Model file to write")->type_name("JSON");
  verb->add_flag("--force", arguments->force, "Replace an existing file");
  verb->add_flag("--json", arguments->json, "Print one JSON object");
  verb->parse_complete_callback([verb, arguments] { check_usage(*verb, *arguments); });
  verbs.emplace_back(verb, [arguments] { return run_fit(*arguments); });
}

}  // namespace palpate::cli
