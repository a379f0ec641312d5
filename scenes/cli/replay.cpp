// palpate replay: models against recordings, through the tick of the live loop.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/base/text.h"
#include "scenes/cli/check_recordings.h"
#include "scenes/cli/replay_plot.h"
#include "scenes/cli/replayed_recording.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

using OrderedJson = nlohmann::ordered_json;

struct Options {
  std::vector<std::string> recordings;
  std::vector<std::string> models;
  std::vector<std::string> names;
  std::string out;
  std::string plot;
  bool json = false;
  bool force = false;
};

// The output must not replace what is being read, --force or not.
Status check_output(const Options& options, const std::string& option, const std::string& out) {
  if (options.recordings.size() > 1) {
    return Error{"found " + std::to_string(options.recordings.size()) +
                 " recordings with " + option + ", expected one; replay them in several runs"};
  }
  std::vector<std::string> inputs = options.models;
  inputs.push_back(options.recordings.front());
  for (const std::string& input : inputs) {
    std::error_code missing;
    if (std::filesystem::equivalent(out, input, missing)) {
      return Error{out + " is the file to read from, expected another one for " + option + "; name a new file"};
    }
  }
  return {};
}

OrderedJson bins_json(const std::vector<ForceBin>& bins) {
  OrderedJson list = OrderedJson::array();
  for (const ForceBin& bin : bins) {
    list.push_back({{"force_from_N", bin.force_from_N},
                    {"force_to_N", bin.force_to_N},
                    {"count", bin.count},
                    {"mean_abs_error_N", bin.mean_abs_error_N},
                    {"std_abs_error_N", bin.std_abs_error_N},
                    {"max_abs_error_N", bin.max_abs_error_N},
                    {"jnd_N", bin.jnd_N}});
  }
  return list;
}

// Figures over no sample are null: there is no number that would be true.
void add_figures(OrderedJson& object, const ErrorSummary& errors) {
  const auto figure = [&](double value) { return errors.samples > 0 ? OrderedJson(value) : OrderedJson(nullptr); };
  object["rms_error_N"] = figure(errors.rms_error_N);
  object["max_error_N"] = figure(errors.max_error_N);
  object["within_jnd"] = figure(errors.within_jnd);
  object["p99_error_over_jnd"] = figure(errors.p99_error_over_jnd);
  object["max_error_over_jnd"] = figure(errors.max_error_over_jnd);
}

OrderedJson model_json(const LoadedModel& one, const ModelErrors& errors) {
  const auto time = [&](double value) { return errors.time.measured ? OrderedJson(value) : OrderedJson(nullptr); };
  OrderedJson object = {
      {"name", one.name}, {"method", one.model->method()}, {"centres", one.model->centre_count()}};
  add_figures(object, errors.as_recorded);
  object["out_of_domain_samples"] = errors.as_recorded.out_of_domain_samples;
  object["evaluation_ns"] = {{"median", time(errors.time.median_ns)}, {"p99", time(errors.time.p99_ns)}};
  OrderedJson moved;
  add_figures(moved, errors.surface_moved);
  object["surface_moved"] = std::move(moved);
  const auto bound = [&](double value) { return std::isnan(value) ? OrderedJson(nullptr) : OrderedJson(value); };
  object["predicted_error"] = {{"bound_95_held", bound(errors.bound.held_share)},
                               {"median_bound_N", bound(errors.bound.median_N)}};
  object["bins"] = bins_json(errors.as_recorded.bins);
  return object;
}

OrderedJson recording_json(const ReplayedRecording& replayed, const std::vector<LoadedModel>& models) {
  OrderedJson list = OrderedJson::array();
  for (std::size_t i = 0; i < models.size(); ++i) list.push_back(model_json(models[i], replayed.models[i]));
  return {{"recording", replayed.path},
          {"samples", replayed.samples},
          {"contact_samples", replayed.contact_samples},
          {"surface_offset_m", replayed.surface_offset_m},
          {"models", list}};
}

void print_json(const std::vector<ReplayedRecording>& all, const std::vector<LoadedModel>& models) {
  OrderedJson list = OrderedJson::array();
  for (const ReplayedRecording& replayed : all) list.push_back(recording_json(replayed, models));
  // A path need not be UTF-8; what cannot be said is replaced.
  std::printf("%s\n", (all.size() == 1 ? list.front() : list)
                          .dump(2, ' ', false, OrderedJson::error_handler_t::replace).c_str());
}

using Row = std::vector<std::string>;

Row table_row(const LoadedModel& one, const ModelErrors& model) {
  const auto figure = [&](const ErrorSummary& errors, double value, int decimals) {
    return errors.samples > 0 ? fixed(value, decimals) : std::string("-");
  };
  const ErrorSummary& errors = model.as_recorded;
  const ErrorSummary& moved = model.surface_moved;
  const auto time = [&](double value) { return model.time.measured ? fixed(value, 0) : std::string("-"); };
  return {one.name,
          std::to_string(one.model->centre_count()),
          figure(errors, 1e3 * errors.rms_error_N, 1),
          figure(errors, 1e3 * errors.max_error_N, 1),
          figure(errors, 1e2 * errors.within_jnd, 2),
          figure(errors, errors.p99_error_over_jnd, 2),
          figure(errors, errors.max_error_over_jnd, 2),
          std::to_string(errors.out_of_domain_samples),
          figure(moved, 1e3 * moved.rms_error_N, 1),
          figure(moved, 1e3 * moved.max_error_N, 1),
          figure(moved, 1e2 * moved.within_jnd, 2),
          figure(moved, moved.p99_error_over_jnd, 2),
          figure(moved, moved.max_error_over_jnd, 2),
          time(model.time.median_ns),
          time(model.time.p99_ns)};
}

std::string surface_text(const ReplayedRecording& replayed) {
  if (!std::isfinite(replayed.surface_error_m)) return "surface not found";
  const std::string error = fixed(1e3 * replayed.surface_error_m, 3) + " mm";
  if (replayed.surface_offset_m == 0.0) return "surface where the models have it, +- " + error;
  return "surface at " + fixed(1e3 * replayed.surface_offset_m, 3) + " +- " + error;
}

void print_table(const ReplayedRecording& replayed, const std::vector<LoadedModel>& models) {
  std::printf("%s: %llu samples, %llu in contact, %s\n", replayed.path.c_str(),
              static_cast<unsigned long long>(replayed.samples),
              static_cast<unsigned long long>(replayed.contact_samples), surface_text(replayed).c_str());
  std::vector<Row> rows = {{"MODEL", "CENTRES", "RMS mN", "MAX mN", "WITHIN JND %", "P99 JND", "MAX JND",
                            "OUT OF DOMAIN", "MOVED: RMS mN", "MAX mN", "WITHIN JND %", "P99 JND", "MAX JND",
                            "MEDIAN ns", "P99 ns"}};
  for (std::size_t i = 0; i < models.size(); ++i) rows.push_back(table_row(models[i], replayed.models[i]));
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const Row& row : rows) {
    std::string line = row[0] + std::string(widths[0] - row[0].size(), ' ');
    for (std::size_t i = 1; i < row.size(); ++i) line += "  " + std::string(widths[i] - row[i].size(), ' ') + row[i];
    std::printf("%s\n", line.c_str());
  }
  if (const std::string remark = surface_remark(replayed, models); !remark.empty()) std::printf("note: %s\n", remark.c_str());
}

Status run(const Options& options) {
  if (!options.out.empty()) {
    if (const Status status = check_output(options, "--out", options.out); !status) return status;
  }
  if (!options.plot.empty()) {
    if (const Status status = check_output(options, "--plot", options.plot); !status) return status;
    if (const Status status = check_plot_path(options.plot, options.force); !status) return status;
  }
  const auto models = load_models(options.models, options.names);
  if (!models) return models.error();
  CheckRequest request;
  request.jnd = models->front().model->data().jnd;
  if (const auto checked = check_before_use(options.recordings, request); !checked) return checked.error();
  std::vector<ReplayedRecording> all;
  ReplayPlot plot(*models);
  ReplayVisitor also;
  if (!options.plot.empty()) {
    also = [&plot](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick&) { plot.add(row, snapshot); };
  }
  for (const std::string& recording : options.recordings) {
    auto replayed = replay_recording(recording, *models, options.out, options.force, also);
    if (!replayed) return replayed.error();
    all.push_back(std::move(*replayed));
  }
  if (!options.plot.empty()) {
    const std::string name = std::filesystem::path(options.recordings.front()).filename().string();
    if (const Status status = plot.draw(options.plot, name, options.force); !status) return status;
  }
  if (options.json) {
    print_json(all, *models);
  } else {
    for (const ReplayedRecording& replayed : all) print_table(replayed, *models);
  }
  return {};
}

}  // namespace

void add_replay(CLI::App& app, Verbs& verbs) {
  CLI::App* command = app.add_subcommand("replay", "Run models over recordings and measure their errors");
  const auto options = std::make_shared<Options>();
  command->add_option("--recording", options->recordings, "Recordings to replay; repeat the option or list them")
      ->required()->type_name("CSV");
  command->add_option("--model", options->models, "Model file (JSON); up to 16, repeat the option or list them")
      ->required();
  command->add_option("--name", options->names, "What to call the models, one for each, in their order");
  command->add_option("--plot", options->plot, "Draw force, differences in the JND band and errors (.svg or .png)");
  command->add_option("--out", options->out, "Write features and forces, row by row, to this file (CSV)");
  command->add_flag("--json", options->json, "Print one JSON object instead of a table");
  command->add_flag("--force", options->force, "Write over an existing file");
  verbs.emplace_back(command, [options] { return run(*options); });
}

}  // namespace palpate::cli
