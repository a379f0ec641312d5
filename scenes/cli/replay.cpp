// palpate replay: compares models with recordings, through the tick of the live loop.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/tick/haptics_tick.h"
#include "models/samples/samples.h"
#include "scenes/cli/verbs.h"
#include "scenes/evaluation/evaluate.h"
#include "scenes/plot/plot.h"
#include "scenes/report/publish.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

struct Options {
  std::vector<std::string> recordings, models, names;
  std::string after, out, plot;
  bool all = false, json = false, force = false;
};

struct LoadedModel {
  std::string name;  // unique among the models of one run
  std::shared_ptr<const FittedModel> model;
};

struct ReplayedModel {
  LoadedModel loaded;
  ErrorSummary as_recorded, surface_moved, beginning_moved;
  double beginning_m = 0.0;   // of `beginning_moved`; 0: there is none
  ErrorSummary force_zeroed;  // with the force of the recording's free air subtracted; empty where it is 0
  OffsetEstimate surface;
  ModelTiming time;
  std::string began;  // how the stream began (began_words)
};

struct ReplayedRecording {
  std::string path;
  std::uint64_t samples = 0, contact_samples = 0;
  double force_zero_N = 0.0;  // of its free air
  std::vector<ReplayedModel> models;
};

// A figure of merit; no number if there are no samples in contact.
struct ErrorColumn {
  const char* key;
  const char* title;
  double ErrorSummary::*value;
  double scale;  // factor in the table
  int decimals;
  bool decides;  // shown without --all
};
constexpr ErrorColumn kFigures[] = {{"rms_error_N", "RMS mN", &ErrorSummary::rms_error_N, kInMilli, 1, true},
                                    {"max_error_N", "MAX mN", &ErrorSummary::max_error_N, kInMilli, 1, false},
                                    {"within_jnd", "WITHIN JND %", &ErrorSummary::within_jnd, kInPercent, 2, true},
                                    {"p99_error_over_jnd", "P99 JND", &ErrorSummary::p99_error_over_jnd, 1.0, 2, true},
                                    {"max_error_over_jnd", "MAX JND", &ErrorSummary::max_error_over_jnd, 1.0, 2, true}};

// `names` with suffixes -2, -3 ... for repeated names.
std::vector<std::string> distinct_names(const std::vector<std::string>& names) {
  std::vector<std::string> distinct;
  for (const std::string& name : names) {
    std::string candidate = name;
    for (int i = 2; std::ranges::count(distinct, candidate) > 0; ++i) candidate = name + "-" + std::to_string(i);
    distinct.push_back(candidate);
  }
  return distinct;
}

// `given`: one name for each file. Empty: the names in the files, or the file names where those are equal. Errors: more
// than kMaxModels models; another number of names; a file that is no model.
Result<std::vector<LoadedModel>> load_models(const std::vector<std::string>& paths,
                                             const std::vector<std::string>& given) {
  if (paths.size() > kMaxModels) {
    return Error{"found " + std::to_string(paths.size()) + " models, expected at most " + std::to_string(kMaxModels) +
                 "; replay them in several runs"};
  }
  if (!given.empty() && given.size() != paths.size()) {
    return Error{"found " + std::to_string(given.size()) + " names for " + std::to_string(paths.size()) +
                 " models, expected one each; give --name once for every --model"};
  }
  std::vector<LoadedModel> loaded;
  for (const std::string& path : paths) {
    const auto model = load_model_file(path, "give it with --recording");
    if (!model) return model.error();
    loaded.push_back({(*model)->name(), *model});
  }
  std::vector<std::string> names = given;
  for (std::size_t i = 0; given.empty() && i < loaded.size(); ++i) {
    const bool unique = std::ranges::count(loaded, loaded[i].name, &LoadedModel::name) == 1;
    names.push_back(unique ? loaded[i].name : std::filesystem::path(paths[i]).stem().string());
  }
  names = distinct_names(names);
  for (std::size_t i = 0; i < loaded.size(); ++i) loaded[i].name = names[i];
  return loaded;
}

// The output file of each recording: `path` for one, NAME_RECORDING.csv for several; empty if `path` is empty.
std::vector<std::string> outputs(const std::string& path, const std::vector<std::string>& recordings) {
  if (path.empty() || recordings.size() == 1) return std::vector<std::string>(recordings.size(), path);
  const fs::path given(path);
  std::vector<std::string> names;
  for (const std::string& recording : recordings) names.push_back(fs::path(recording).stem().string());
  std::vector<std::string> paths;
  for (const std::string& name : distinct_names(names)) {
    paths.push_back((given.parent_path() / (given.stem().string() + "_" + name + given.extension().string())).string());
  }
  return paths;
}

// One row for each model, for --json and the terminal. `all`: all figures are on the terminal.
Table models_table(const ReplayedRecording& replayed, bool all) {
  Table table{"models"};
  for (const ReplayedModel& one : replayed.models) {
    const auto& [name, model] = one.loaded;
    const auto add = [&](const std::string& key, const std::string& title, TableCell cell, double scale = 1.0,
                         int decimals = 0) {
      table.add({key, all ? title : "", scale, decimals}, std::move(cell));
    };
    const auto add_errors = [&](const std::string& group, const char* before, const ErrorSummary& errors) {
      for (const ErrorColumn& figure : kFigures) {
        const bool shown = before != nullptr && (all || (group.empty() && figure.decides));
        table.add({group + figure.key, shown ? std::string(before) + figure.title : "", figure.scale, figure.decimals},
                  errors.samples > 0 ? errors.*figure.value : kNoNumber);
      }
    };
    const auto time = [&](double time_ns) { return one.time.measured ? time_ns : kNoNumber; };
    table.begin_row();
    table.add({"name", "MODEL"}, name);
    add("method", "", model->method());
    add("centres", "CENTRES", model->centre_count());
    add("began", "", one.began);
    add_errors("", "", one.as_recorded);
    add("out_of_domain_samples", "OUT OF DOMAIN", one.as_recorded.out_of_domain_samples);
    add("evaluation_ns.median", "", time(one.time.evaluation.median_ns));
    add("evaluation_ns.p99", "", time(one.time.evaluation.p99_ns));
    table.add({"tick_ns.median", "TICK ns", 1.0, 0}, time(one.time.tick.median_ns));
    add("tick_ns.p99", "TICK P99 ns", time(one.time.tick.p99_ns));
    add_errors("surface_moved.", "ALIGNED ", one.surface_moved);
    add_errors("force_zeroed.", nullptr, one.force_zeroed);
    add("surface_offset_m", "SURFACE mm", one.surface.at, kInMilli, 3);
    add("", "+- mm", one.surface.identified ? one.surface.standard_error : kNoNumber, kInMilli, 3);
    add("beginning_moved.offset_m", "", one.beginning_m);
    add_errors("beginning_moved.", nullptr, one.beginning_moved);
    add("", "BEGINNING MOVED WITHIN JND %", one.beginning_m != 0.0 ? one.beginning_moved.within_jnd : kNoNumber,
        kInPercent, 2);
    add("surface_identified", "", one.surface.identified);
    add("predicted_error.bound_95_held", "WITHIN BOUND %", one.as_recorded.bound.coverage, kInPercent, 1);
    add("predicted_error.bound_95_held_moved", "ALIGNED WITHIN BOUND %", one.surface_moved.bound.coverage, kInPercent,
        1);
    add("predicted_error.median_bound_N", "", one.as_recorded.bound.median_N);
    add("predicted_error.median_bound_over_jnd", "BOUND JND", one.as_recorded.bound.median_over_jnd, 1.0, 2);
  }
  return table;
}

OrderedJson recording_json(const ReplayedRecording& replayed) {
  OrderedJson list = table_json(models_table(replayed, true));
  for (std::size_t i = 0; i < list.size(); ++i) {
    const ReplayedModel& one = replayed.models[i];
    if (one.force_zeroed.samples == 0) list[i]["force_zeroed"] = nullptr;
    if (one.beginning_m == 0.0) list[i]["beginning_moved"] = nullptr;
    if (!one.as_recorded.bound.has_bounds()) list[i]["predicted_error"] = nullptr;
    OrderedJson& bins = list[i]["bins"] = OrderedJson::array();
    for (const ForceBin& bin : one.as_recorded.bins) {
      bins.push_back({{"force_from_N", bin.force_from_N},
                      {"force_to_N", bin.force_to_N},
                      {"count", bin.force_N.count()},
                      {"mean_abs_error_N", bin.error_N.mean()},
                      {"std_abs_error_N", bin.error_N.deviation()},
                      {"max_abs_error_N", bin.error_N.largest()},
                      {"jnd_N", bin.jnd_N}});
    }
  }
  return {{"recording", replayed.path},
          {"samples", replayed.samples},
          {"contact_samples", replayed.contact_samples},
          {"force_zero_N", replayed.force_zero_N},
          {"surface_offset_m", replayed.models.front().surface.at},
          {"models", list}};
}

// The largest change of a share within the JND by moving the surface, unless it is small.
void print_surface_note(const std::vector<ReplayedModel>& models) {
  const auto change = [](const ReplayedModel& one) {
    return std::abs(one.surface_moved.within_jnd - one.as_recorded.within_jnd);
  };
  const ReplayedModel& most = *std::ranges::max_element(models, {}, change);
  if (change(most) <= kLeastShare) return;
  std::printf(
      "note: the surface of this recording is at %+.3f mm for %.64s, which changes the figures: "
      "%.2f %% within the JND and %.1f mN RMS as recorded, %.2f %% and %.1f mN with the surface aligned; "
      "that is estimated from these same forces\n",
      1e3 * most.surface.at, most.loaded.name.c_str(), 1e2 * most.as_recorded.within_jnd,
      1e3 * most.as_recorded.rms_error_N, 1e2 * most.surface_moved.within_jnd, 1e3 * most.surface_moved.rms_error_N);
}

// Says, of the first such model, that the recording begins in contact with the memory of another one.
void print_beginning_note(const std::vector<ReplayedModel>& models) {
  const auto rested = [](const ReplayedModel& one) { return one.began == began_words({}, kBeganAtRest); };
  const auto first = std::ranges::find_if_not(models, rested);
  if (first == models.end()) return;
  std::printf("note: for %.64s the material begins %.200s, not at rest\n", first->loaded.name.c_str(),
              first->began.c_str());
}

// Says, for the first such model, that the recording begins with the force of a training recording, elsewhere.
void print_preload_note(const std::vector<ReplayedModel>& models) {
  const auto first = std::ranges::find_if(models, [](const ReplayedModel& one) { return one.beginning_m != 0.0; });
  if (first == models.end()) return;
  std::printf(
      "note: this recording begins with the force of a training recording of %.64s, %+.3f mm from it: %.2f %% within "
      "the JND as recorded, %.2f %% with both beginnings at one place; that uses a force of the test\n",
      first->loaded.name.c_str(), 1e3 * first->beginning_m, 1e2 * first->as_recorded.within_jnd,
      1e2 * first->beginning_moved.within_jnd);
}

// Says, for the first such model, that the recording does not distinguish an offset of the surface and of the force.
void print_ambiguity_note(const std::vector<ReplayedModel>& models) {
  const auto ambiguous = [](const ReplayedModel& one) { return one.surface.force_offset_N != 0.0; };
  const auto first = std::ranges::find_if(models, ambiguous);
  if (first == models.end()) return;
  std::printf(
      "note: for %.64s a force offset of %+.3f N explains this recording %s a surface at %+.3f mm: neither is "
      "corrected\n",
      first->loaded.name.c_str(), first->surface.force_offset_N,
      first->surface.force_offset_better ? "better than" : "as well as", 1e3 * first->surface.minimum_at);
}

void print_recording(const ReplayedRecording& replayed, bool all) {
  std::printf("%s: %llu samples, %llu in contact", replayed.path.c_str(),
              static_cast<unsigned long long>(replayed.samples),
              static_cast<unsigned long long>(replayed.contact_samples));
  if (const ReplayedModel& first = replayed.models.front(); replayed.force_zero_N != 0.0)
    std::printf("; its free air reads %+.3g N: forces counted from there, %.64s has %.2f %% within the JND",
                replayed.force_zero_N, first.loaded.name.c_str(), 1e2 * first.force_zeroed.within_jnd);
  std::printf("\n");
  print_table(table_text(models_table(replayed, all)), true);
  if (replayed.contact_samples == 0)
    std::printf(
        "note: no sample is beyond the surface of a model or has a certain force, so that nothing is compared\n");
  print_beginning_note(replayed.models);
  print_surface_note(replayed.models);
  print_preload_note(replayed.models);
  print_ambiguity_note(replayed.models);
}

// Each distinct feature: the first model that has it, and its index in the features of that model.
using FeatureColumns = std::vector<std::pair<std::size_t, std::size_t>>;

FeatureColumns distinct_features(const std::vector<LoadedModel>& models) {
  FeatureColumns columns;
  std::vector<FeatureSpec> specs;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const std::vector<FeatureSpec>& features = models[m].model->features();
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (std::ranges::count(specs, features[i]) > 0) continue;
      specs.push_back(features[i]);
      columns.emplace_back(m, i);
    }
  }
  return columns;
}

// FORCES.csv with one row per sample: time_s, position_m, force_N, depth_m, each distinct feature of the models, then
// "<model name>_N" for each model.
std::string forces_header(const std::vector<LoadedModel>& models, const FeatureColumns& columns) {
  std::vector<std::string> features, names{"time_s", "position_m", "force_N", "depth_m"};
  for (const auto& [model, index] : columns) features.push_back(feature_name(models[model].model->features()[index]));
  std::ranges::copy(distinct_names(features), std::back_inserter(names));
  for (const LoadedModel& one : models) names.push_back(one.name + "_N");
  return joined(names, ",") + "\n";
}

std::string forces_row(const FeatureColumns& columns, const RecordingRow& row, const TickSnapshot& snapshot,
                       const HapticsTick& tick) {
  std::vector<std::string> cells;
  for (const double value : {row.time_s, row.position_m, row.force_N, snapshot.depth_m})
    cells.push_back(shortest(value));
  for (const auto& [model, index] : columns) cells.push_back(shortest(tick.features_of(model).values[index]));
  for (std::size_t m = 0; m < tick.model_count(); ++m) cells.push_back(shortest(snapshot.force_N[m]));
  return joined(cells, ",") + "\n";
}

// Draws the measured force, every model's difference from it over the JND, and the error against the force.
Status draw_replay(const std::string& path, const std::string& recording, const std::vector<ReplayedModel>& models,
                   const std::vector<ComparedMoment>& moments, bool overwrite) {
  std::vector<ComparedModel> compared;
  Panel against{.x = {"Measured force [N]"}, .y = {"Mean error + deviation", "N", true}, .names_at_ends = true};
  Series jnd{"JND", kMutedColour, Mark::dashed, {}};
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto& [name, model] = models[i].loaded;
    compared.push_back({{name, method_rgb(model->method()), Mark::line, {}}, model->data().jnd});
    Series& series = against.series.emplace_back(compared.back().curve);
    series.mark = Mark::curve;
    for (const ForceBin& bin : models[i].as_recorded.bins) {
      if (bin.force_N.count() > 0)
        series.rows.push_back({bin.force_N.mean(), bin.error_N.mean() + bin.error_N.deviation()});
      if (i == 0) jnd.rows.push_back({0.5 * (bin.force_from_N + bin.force_to_N), bin.jnd_N});
    }
  }
  merge_equal(against.series);
  against.series.push_back(std::move(jnd));
  Plot plot{.name = "replay", .height = 0.7, .panels = compared_forces(recording, compared, moments)};
  plot.panels.push_back(std::move(against));
  return draw_plot(plot, path, overwrite);
}

// `after`: the recording that this one continues; null: none. `forces_path`: features and forces; `plot_path`: a
// figure. Empty: not requested.
Result<ReplayedRecording> replay_one(const CheckedFile& checked, const Recording* after,
                                     const std::vector<LoadedModel>& models, const std::string& forces_path,
                                     const std::string& plot_path, bool overwrite) {
  std::vector<EvaluatedModel> evaluated;
  std::vector<ModelPointer> pointers;
  for (const LoadedModel& one : models) {
    evaluated.push_back({one.model, one.model->data().jnd});
    pointers.push_back(one.model);
  }
  const FeatureColumns columns = distinct_features(models);
  std::optional<AtomicFile> forces;
  std::vector<ComparedMoment> moments;
  if (!forces_path.empty()) {
    auto file = AtomicFile::create(forces_path, overwrite);
    if (!file) return file.error();
    forces.emplace(std::move(*file));
    forces->write(forces_header(models, columns));
  }
  // A test keeps every row, also those that a fit would leave out.
  const Result<Recording> whole = read_recording(checked.path);
  if (!whole) return whole.error();
  EvaluationRequest request{.after = after, .move_beginning = true};
  request.also = [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
    if (forces) forces->write(forces_row(columns, row, snapshot, tick));
    const auto begin = snapshot.force_N.begin();
    if (!plot_path.empty())
      moments.push_back({row.time_s, row.force_N, snapshot.in_contact, {begin, begin + snapshot.model_count}});
  };
  const auto evaluation = evaluate(*whole, evaluated, request);
  if (!evaluation) return evaluation.error();
  request.also = {};
  request.force_zero_N = checked.prepared->surface.force_zero_N;
  request.move_surface = request.move_beginning = false;
  Evaluation zeroed;
  if (request.force_zero_N != 0.0) {
    auto evaluated_again = evaluate(*whole, evaluated, request);
    if (!evaluated_again) return evaluated_again.error();
    zeroed = std::move(*evaluated_again);
  }
  if (forces) {
    if (const Status status = forces->commit(); !status) return status.error();
  }
  ReplayedRecording replayed{
      checked.path, evaluation->samples, evaluation->no_force.summary().samples, request.force_zero_N, {}};
  const std::vector<ModelTiming> times = time_models(pointers, evaluation->timing);
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto& [recorded, moved, begins, surfaces, began, beginning_m] = evaluation->models[i];
    replayed.models.push_back({models[i], recorded.summary(), moved.summary(), begins.summary(), beginning_m,
                               zeroed.models.empty() ? ErrorSummary{} : zeroed.models[i].as_recorded.summary(),
                               surfaces.front(), times[i], began_words(models[i].model->data(), began)});
  }
  if (plot_path.empty()) return replayed;
  const Status drawn =
      draw_replay(plot_path, fs::path(checked.path).filename().string(), replayed.models, moments, overwrite);
  return drawn ? Result<ReplayedRecording>(std::move(replayed)) : drawn.error();
}

Status run(const Options& options) {
  std::vector<std::string> inputs = options.models;
  inputs.insert(inputs.end(), options.recordings.begin(), options.recordings.end());
  const std::vector<std::string> forces = outputs(options.out, options.recordings);
  const std::vector<std::string> plots = outputs(options.plot, options.recordings);
  for (std::size_t i = 0; i < options.recordings.size(); ++i) {
    for (const auto& [option, path] : {std::pair{"--out", forces[i]}, {"--plot", plots[i]}}) {
      const Status status = path.empty() ? Status() : refuse_input_as_output(path, inputs, option);
      if (!status) return status;
    }
    if (plots[i].empty()) continue;
    const auto place = [](const std::string& path) { return fs::absolute(path).lexically_normal(); };
    if (!forces[i].empty() && place(plots[i]) == place(forces[i]))
      throw CLI::ValidationError("--plot", "found " + plots[i] + ", the file of --out, expected another file");
    if (const auto trial = AtomicFile::create(plots[i], options.force); !trial) return trial.error();
  }
  const auto models = load_models(options.models, options.names);
  if (!models) return models.error();
  std::string header = "," + forces_header(*models, distinct_features(*models));
  header.back() = ',';
  for (const LoadedModel& one : *models) {
    const std::string column = "," + one.name + "_N,";  // in the header twice, if it is there already
    if (!options.out.empty() && header.find(column) < header.rfind(column))
      return Error{"found the model name " + one.name + ", which gives a column that " + options.out +
                   " has already; give another with --name"};
    if (options.out.empty() || one.name.find_first_of(",\"\r\n") == std::string::npos) continue;
    return Error{"found the model name " + printable(one.name) +
                 ", expected one without comma, quote and line break, " +
                 "because it becomes the header of a column; give another with --name"};
  }
  CheckRequest request;
  request.jnd = models->front().model->data().jnd;
  const auto checked = check_before_use(options.recordings, request);
  if (!checked) return checked.error();
  std::optional<Recording> after;
  if (!options.after.empty()) {
    auto read = read_recording_before(options.after, *checked);
    if (!read) return read.error();
    after = std::move(*read);
  }
  std::vector<ReplayedRecording> all;
  for (std::size_t i = 0; i < checked->size(); ++i) {
    auto replayed = replay_one((*checked)[i], after ? &*after : nullptr, *models, forces[i], plots[i], options.force);
    if (!replayed) return replayed.error();
    all.push_back(std::move(*replayed));
  }
  if (options.json) {
    OrderedJson list = OrderedJson::array();
    for (const ReplayedRecording& replayed : all) list.push_back(recording_json(replayed));
    print_json(list.size() == 1 ? list.front() : list);
  } else {
    for (const ReplayedRecording& replayed : all) print_recording(replayed, options.all);
    for (const auto* paths : {&forces, &plots})
      for (const std::string& path : *paths)
        if (!path.empty()) std::printf("written  %s\n", printable(path, std::string::npos).c_str());
  }
  return {};
}

}  // namespace

void add_replay(CLI::App& app, Verbs& verbs) {
  CLI::App* command = app.add_subcommand("replay", "Run models over recordings and measure their errors");
  const auto options = std::make_shared<Options>();
  command->add_option("--recording", options->recordings, "Recordings to replay (CSV), one or more")
      ->required()
      ->type_name("CSV");
  command
      ->add_option("--after", options->after,
                   "Recording that these continue: the models begin with the memory of its end (CSV)")
      ->type_name("CSV");
  command->add_option("--model", options->models, "Model files (JSON), 1 to 16")->required();
  command->add_option("--name", options->names,
                      "Names of the models in the results, one for each --model in the same order [as in the files]");
  command
      ->add_option("--plot", options->plot,
                   "Figure to draw (.svg or .png): force, errors in JND, and errors over force; for several "
                   "recordings PLOT_RECORDING")
      ->check(CLI::Validator(plot_ending_error, ""));
  command->add_option("--out", options->out,
                      "File to write (CSV): features and forces of every row; for several recordings OUT_RECORDING");
  command->add_flag("--all", options->all, "Print all figures, also with the surface aligned to this recording");
  command->add_flag("--json", options->json, "Print one JSON object instead of a table");
  command->add_flag("--force", options->force, "Replace an existing file");
  verbs.emplace_back(command, [options] { return run(*options); });
}

}  // namespace palpate::cli
