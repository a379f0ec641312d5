// palpate fit: recordings in, a model file out.
#include <chrono>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "engine/base/atomic_file.h"
#include "models/fit/fit.h"
#include "models/model/file/model_io.h"
#include "scenes/cli/feature_list.h"
#include "scenes/cli/progress.h"
#include "scenes/cli/verbs.h"
#include "scenes/scene/scene.h"
#include "scenes/scene/training.h"

namespace palpate::cli {
namespace {

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
  std::string grid;
  std::string scene = "silicone_block";
  std::string solver = "cholesky";
  std::uint64_t seed = 1;
  std::string out;
  bool force = false;
  bool json = false;
};

// "0.17,1.27" as positive numbers; empty when it is anything else.
std::vector<double> parse_times(const std::string& text) {
  std::vector<double> times;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !(value > 0.0) || !std::isfinite(value)) return {};
    times.push_back(value);
    if (next == end) return times;
    if (*next != ',') return {};
    at = next + 1;
  }
  return {};
}

// "25x11x11x11" as whole numbers of at least 2; empty when it is anything else.
std::vector<int> parse_grid(const std::string& text) {
  std::vector<int> sizes;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    int value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || value < 2) return {};
    sizes.push_back(value);
    if (next == end) return sizes;
    if (*next != 'x') return {};
    at = next + 1;
  }
  return {};
}

std::string check_candidates(const std::string& text) {
  int value = 0;
  const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc() && next == text.data() + text.size() && value >= 1;
  return number || text == "all" ? "" : "found \"" + text + "\", expected a whole number of at least 1, or all";
}

std::string check_relaxation(const std::string& text) {
  if (text == "scene" || text == "auto") return "";
  const std::size_t count = parse_times(text).size();
  if (count >= 1 && count <= 6) return "";
  return "found \"" + text + "\", expected scene, auto, or one to six times in seconds such as 0.17,1.27";
}

std::string check_features(const std::string& text) {
  if (text == "auto" || text == "scene") return "";
  const auto list = parse_feature_list(text);
  return list ? "" : list.error().message + "; or auto, or scene";
}

std::string check_grid(const std::string& text) {
  return parse_grid(text).empty() ? "found \"" + text + "\", expected sizes such as 25x11x11x11" : "";
}

TrainingRequest training_request(const FitArguments& arguments, const Scene& scene) {
  TrainingRequest request = palpate::training_request(scene);
  request.weighting = arguments.weighting == "jnd"        ? Weighting::jnd
                      : arguments.weighting == "relative" ? Weighting::relative
                                                          : Weighting::none;
  request.reduction = arguments.reduction == "coverage" ? Reduction::coverage
                      : arguments.reduction == "force"  ? Reduction::force
                                                        : Reduction::none;
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
  if (arguments.relaxation == "auto") {
    request.relaxation = Relaxation::automatic;
  } else if (!arguments.relaxation.empty() && arguments.relaxation != "scene") {
    request.relaxation = Relaxation::given;
    request.relaxation_times_s = parse_times(arguments.relaxation);
  }
  return request;
}

MethodRequest method_request(const FitArguments& arguments) {
  MethodRequest request;
  request.method = *method_from_name(arguments.method);
  request.centres = arguments.centres;
  request.candidates = arguments.candidates == "all" ? 0 : std::stoi(arguments.candidates);
  request.kernel = *kernel_from_name(arguments.kernel);
  request.solver = arguments.solver == "tsvd" ? DirectSolverChoice::tsvd : DirectSolverChoice::cholesky;
  request.grid = parse_grid(arguments.grid);
  request.seed = arguments.seed;
  return request;
}

std::string relaxation_text(const std::vector<RelaxationTime>& times) {
  std::string text;
  for (const RelaxationTime& time : times) {
    char one[64];
    if (time.standard_error_s > 0.0) {
      std::snprintf(one, sizeof one, "%.3g s +- %.2g", time.time_s, time.standard_error_s);
    } else {
      std::snprintf(one, sizeof one, "%.3g s", time.time_s);
    }
    text += (text.empty() ? "" : ", ") + std::string(one);
  }
  return text.empty() ? "none" : text;
}

// One row a feature: what the trend's error on strokes left out is with it and
// without it.
void print_worth(const FeatureSelection& selection) {
  if (selection.worth.empty()) return;
  std::printf("%-32s %-5s %12s %12s   RMS over the JND, strokes left out\n", "FEATURE", "TAKEN", "WITH", "WITHOUT");
  for (const FeatureWorth& one : selection.worth) {
    std::printf("%-32s %-5s %12.4f %12.4f\n", one.name.c_str(), one.taken ? "yes" : "no", one.error_with,
                one.error_without);
  }
  std::fflush(stdout);
}

std::string strength_text(const StrengthChoice& strength) {
  char text[160];
  std::snprintf(text, sizeof text, "%.0f %% of it; RMS over the JND on strokes left out %.4f, %.4f without it",
                100.0 * strength.strength, strength.error_over_jnd, strength.trend_error_over_jnd);
  return text;
}

void print_summary(const MethodFit& fit, const PreparedTraining& prepared, double seconds, const std::string& out) {
  print_worth(prepared.selection);
  const Provenance& provenance = fit.data.provenance;
  std::cout << "model               " << fit.data.name << "\n"
            << "samples             " << provenance.samples << " (" << provenance.contact_samples << " in contact)\n"
            << "after reduction     " << provenance.samples_after_reduction << "\n"
            << "relaxation times    " << relaxation_text(provenance.relaxation_times) << "\n"
            << "correction          " << (prepared.strength ? strength_text(*prepared.strength) : "all of it") << "\n"
            << "condition, rank     " << fit.report.condition << ", " << fit.report.rank << " of "
            << fit.report.columns << "\n"
            << "fit time            " << seconds << " s\n"
            << "training <= JND     " << 100.0 * provenance.training_within_jnd << " %\n";
  for (const std::string& note : fit.report.notes) std::cout << "note                " << note << "\n";
  std::cout << "written             " << out << "\n";
}

nlohmann::ordered_json worth_json(const FeatureSelection& selection) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const FeatureWorth& one : selection.worth) {
    list.push_back({{"name", one.name},
                    {"taken", one.taken},
                    {"error_over_jnd_with", one.error_with},
                    {"error_over_jnd_without", one.error_without}});
  }
  return list;
}

nlohmann::ordered_json strength_json(const std::optional<StrengthChoice>& strength) {
  if (!strength) return nullptr;
  return {{"strength", strength->strength},
          {"smoothing", strength->smoothing},
          {"error_over_jnd", strength->error_over_jnd},
          {"trend_error_over_jnd", strength->trend_error_over_jnd}};
}

void print_json(const MethodFit& fit, const PreparedTraining& prepared, const FitArguments& arguments,
                double seconds) {
  nlohmann::ordered_json features = nlohmann::ordered_json::array();
  for (const FeatureSpec& spec : fit.data.features) features.push_back(feature_name(spec));
  const Provenance& provenance = fit.data.provenance;
  nlohmann::ordered_json times = nlohmann::ordered_json::array();
  for (const RelaxationTime& time : provenance.relaxation_times) {
    times.push_back({{"time_s", time.time_s}, {"standard_error_s", time.standard_error_s}});
  }
  const nlohmann::ordered_json object = {{"method", fit.data.method},
                                         {"centres", FittedModel(fit.data).centre_count()},
                                         {"kernel", arguments.kernel},
                                         {"weighting", arguments.weighting},
                                         {"samples", provenance.samples},
                                         {"samples_after_reduction", provenance.samples_after_reduction},
                                         {"fit_seconds", seconds},
                                         {"training_within_jnd", provenance.training_within_jnd},
                                         {"name", fit.data.name},
                                         {"features", features},
                                         {"feature_worth", worth_json(prepared.selection)},
                                         {"correction", strength_json(prepared.strength)},
                                         {"contact_samples", provenance.contact_samples},
                                         {"relaxation_times", times},
                                         {"condition", fit.report.condition},
                                         {"rank", fit.report.rank},
                                         {"smoothing", fit.report.smoothing},
                                         {"notes", fit.report.notes}};
  std::cout << object.dump(2) << "\n";
}

// Where the model's relaxation times come from.
std::string relaxation_of(const FitArguments& arguments) {
  if (arguments.relaxation == "auto" || arguments.relaxation == "scene") return arguments.relaxation;
  if (!arguments.relaxation.empty()) return "given";
  if (arguments.features == "auto" || arguments.features == "scene") return arguments.features;
  return "given";
}

Status run_fit(const FitArguments& arguments) {
  const auto scene = load_scene(arguments.scene);
  if (!scene) return scene.error();
  // A name that cannot be written is told now and not after the fit.
  if (const auto trial = AtomicFile::create(arguments.out, arguments.force); !trial) return trial.error();
  const auto start = std::chrono::steady_clock::now();
  ProgressLine line("fitting " + arguments.method);
  FitControl prepare;
  prepare.progress = [&](double fraction) { return line.update(fraction); };
  FitControl method;
  method.progress = [&](double fraction) { return line.update(0.3 + 0.7 * fraction); };

  std::vector<MotionSource::Input> inputs;
  for (const std::string& path : arguments.recordings) inputs.push_back({path, nullptr});
  MotionSource source(std::move(inputs));
  const auto prepared = prepare_training(source, training_request(arguments, *scene), prepare);
  if (!prepared) return prepared.error();
  auto fit = fit_method(*prepared, method_request(arguments), method);
  if (!fit) return fit.error();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  fit->data.provenance.fit_seconds = seconds;
  fit->data.provenance.weighting = arguments.weighting;
  fit->data.provenance.reduction = arguments.reduction;
  fit->data.provenance.relaxation = relaxation_of(arguments);
  if (Status status = save_model(arguments.out, fit->data, arguments.force); !status) return status;
  if (arguments.json) {
    print_json(*fit, *prepared, arguments, seconds);
  } else {
    print_summary(*fit, *prepared, seconds, arguments.out);
  }
  return {};
}

}  // namespace

void add_fit(CLI::App& app, Verbs& verbs) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::App* verb = app.add_subcommand("fit", "Fit a force model to recordings");
  verb->add_option("--recording", arguments->recordings, "Training recordings; together one training set")
      ->required()->type_name("CSV");
  verb->add_option("--method", arguments->method, "direct, voxel, random, kdtree or greedy")
      ->required()->check(CLI::IsMember({"direct", "voxel", "random", "kdtree", "greedy"}));
  verb->add_option("--centres", arguments->centres, "Centres of random, kdtree and greedy")
      ->check(CLI::Range(1, 100000))->capture_default_str();
  verb->add_option("--candidates", arguments->candidates, "Sites that greedy tries per step, or all")
      ->check(CLI::Validator(check_candidates, "N|all"))->capture_default_str();
  verb->add_option("--kernel", arguments->kernel, "cubic, linear, thin-plate or quintic")
      ->check(CLI::IsMember({"cubic", "linear", "thin-plate", "quintic"}))->capture_default_str();
  verb->add_option("--weighting", arguments->weighting, "What an error counts: 1/JND, the paper's 1/f, or 1")
      ->check(CLI::IsMember({"jnd", "relative", "none"}))->capture_default_str();
  verb->add_option("--reduction", arguments->reduction,
                   "Which samples become sites: feature space covered, the paper's 50 mN steps, or all")
      ->check(CLI::IsMember({"coverage", "force", "none"}))->capture_default_str();
  verb->add_option("--features", arguments->features,
                   std::string("What the force may depend on: what the recordings support, the scene's features, or a "
                               "list such as ") + kFeatureListExample)
      ->check(CLI::Validator(check_features, "auto|scene|LIST"))->capture_default_str();
  verb->add_option("--relaxation", arguments->relaxation,
                   "The scene's features with its relaxation times, identified ones, or these")
      ->check(CLI::Validator(check_relaxation, "scene|auto|S,S"));
  verb->add_option("--grid", arguments->grid, "Nodes of the voxel grid per feature [25x11x11x11]")
      ->check(CLI::Validator(check_grid, "NxN"));
  verb->add_option("--scene", arguments->scene, "Scene whose features and JND line count")->capture_default_str();
  verb->add_option("--solver", arguments->solver, "Direct and voxel: cholesky, or the paper's truncated SVD")
      ->check(CLI::IsMember({"cholesky", "tsvd"}))->capture_default_str();
  verb->add_option("--seed", arguments->seed, "Of random and greedy")->capture_default_str();
  verb->add_option("--out", arguments->out, "Model file to write")->required()->type_name("JSON");
  verb->add_flag("--force", arguments->force, "Replace an existing file");
  verb->add_flag("--json", arguments->json, "Print one JSON object");
  verbs.emplace_back(verb, [arguments] { return run_fit(*arguments); });
}

}  // namespace palpate::cli
