// palpate replay: models against a recording, through the tick of the live loop.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/text.h"
#include "engine/tick/replay.h"
#include "engine/tick/evaluation.h"
#include "models/model/file/model_io.h"
#include "scenes/cli/forces_file.h"
#include "scenes/scene/model_timing.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

using OrderedJson = nlohmann::ordered_json;

struct Options {
  std::string recording;
  std::vector<std::string> models;
  std::string out;
  bool json = false;
  bool force = false;
};

// One model on its way through the recording.
struct Contestant {
  std::string name;
  std::shared_ptr<const FittedModel> model;
  ErrorStatistics statistics;
  FeatureSample features;
  ErrorSummary errors;
  ModelTiming time;
};

Result<std::vector<Contestant>> load_contestants(const std::vector<std::string>& paths) {
  if (paths.size() > kMaxModels) {
    return Error{"found " + std::to_string(paths.size()) + " models, expected at most " +
                 std::to_string(kMaxModels) + "; replay them in several runs"};
  }
  std::vector<Contestant> contestants;
  std::vector<std::string> names;
  for (const std::string& path : paths) {
    auto model = load_model(path);
    if (!model) return model.error();
    names.push_back((*model)->name());
    contestants.push_back({"", *model, ErrorStatistics((*model)->data().jnd), {}, {}, {}});
  }
  names = distinct_names(names);
  for (std::size_t i = 0; i < names.size(); ++i) contestants[i].name = names[i];
  return contestants;
}

// The output must not replace what is being read, --force or not.
Status check_output(const Options& options) {
  std::vector<std::string> inputs = options.models;
  inputs.push_back(options.recording);
  for (const std::string& input : inputs) {
    std::error_code missing;
    if (std::filesystem::equivalent(options.out, input, missing)) {
      return Error{options.out + " is the file to read from, expected another one for --out; name a new file"};
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
OrderedJson contestant_json(const Contestant& one) {
  const ErrorSummary& errors = one.errors;
  const auto figure = [&](double value) { return errors.samples > 0 ? OrderedJson(value) : OrderedJson(nullptr); };
  const auto time = [&](double value) { return one.time.measured ? OrderedJson(value) : OrderedJson(nullptr); };
  return {{"name", one.name},
          {"method", one.model->method()},
          {"centres", one.model->centre_count()},
          {"rms_error_N", figure(errors.rms_error_N)},
          {"max_error_N", figure(errors.max_error_N)},
          {"within_jnd", figure(errors.within_jnd)},
          {"p99_error_over_jnd", figure(errors.p99_error_over_jnd)},
          {"max_error_over_jnd", figure(errors.max_error_over_jnd)},
          {"out_of_domain_samples", errors.out_of_domain_samples},
          {"evaluation_ns", {{"median", time(one.time.median_ns)}, {"p99", time(one.time.p99_ns)}}},
          {"bins", bins_json(errors.bins)}};
}

void print_json(const Options& options, const ReplaySummary& summary, const std::vector<Contestant>& contestants) {
  OrderedJson models = OrderedJson::array();
  for (const Contestant& one : contestants) models.push_back(contestant_json(one));
  const OrderedJson object = {{"recording", options.recording},
                       {"samples", summary.samples},
                       {"contact_samples", summary.contact_samples},
                       {"models", models}};
  // A path need not be UTF-8; what cannot be said is replaced.
  std::printf("%s\n", object.dump(2, ' ', false, OrderedJson::error_handler_t::replace).c_str());
}

using Row = std::vector<std::string>;

Row table_row(const Contestant& one) {
  const ErrorSummary& errors = one.errors;
  const auto figure = [&](double value, int decimals) {
    return errors.samples > 0 ? fixed(value, decimals) : std::string("-");
  };
  const auto time = [&](double value) { return one.time.measured ? fixed(value, 0) : std::string("-"); };
  return {one.name,
          std::to_string(one.model->centre_count()),
          figure(1e3 * errors.rms_error_N, 1),
          figure(1e3 * errors.max_error_N, 1),
          figure(1e2 * errors.within_jnd, 2),
          figure(errors.p99_error_over_jnd, 2),
          figure(errors.max_error_over_jnd, 2),
          std::to_string(errors.out_of_domain_samples),
          time(one.time.median_ns),
          time(one.time.p99_ns)};
}

void print_table(const Options& options, const ReplaySummary& summary, const std::vector<Contestant>& contestants) {
  std::printf("%s: %llu samples, %llu in contact\n", options.recording.c_str(),
              static_cast<unsigned long long>(summary.samples),
              static_cast<unsigned long long>(summary.contact_samples));
  std::vector<Row> rows = {{"MODEL", "CENTRES", "RMS mN", "MAX mN", "WITHIN JND %", "P99 JND", "MAX JND",
                            "OUT OF DOMAIN", "MEDIAN ns", "P99 ns"}};
  for (const Contestant& one : contestants) rows.push_back(table_row(one));
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const Row& row : rows) {
    std::string line = row[0] + std::string(widths[0] - row[0].size(), ' ');
    for (std::size_t i = 1; i < row.size(); ++i) line += "  " + std::string(widths[i] - row[i].size(), ' ') + row[i];
    std::printf("%s\n", line.c_str());
  }
}

Status run(const Options& options) {
  if (!options.out.empty()) {
    if (const Status status = check_output(options); !status) return status;
  }
  Result<std::vector<Contestant>> contestants = load_contestants(options.models);
  if (!contestants) return contestants.error();
  Result<RecordingReader> reader = RecordingReader::open(options.recording);
  if (!reader) return reader.error();

  ForceModels models;
  std::vector<std::string> names;
  for (const Contestant& one : *contestants) {
    models.push_back(one.model);
    names.push_back(one.name);
  }
  std::optional<ForcesFile> forces;
  if (!options.out.empty()) {
    Result<ForcesFile> file = ForcesFile::create(options.out, options.force, models, names);
    if (!file) return file.error();
    forces.emplace(std::move(*file));
  }
  const Result<ReplaySummary> summary =
      replay(*reader, models, [&](const RecordingRow& row, const TickSnapshot& snapshot, const HapticsTick& tick) {
        if (forces) forces->add(row, snapshot, tick);
        if (!snapshot.in_contact) return;
        for (std::size_t i = 0; i < contestants->size(); ++i) {
          Contestant& one = (*contestants)[i];
          one.statistics.add(snapshot.force_N[i], row.force_N, (snapshot.out_of_domain_mask >> i & 1U) != 0);
          one.features.add(tick.features_of(i));
        }
      });
  if (!summary) return summary.error();
  if (forces) {
    if (const Status status = forces->commit(); !status) return status;
  }
  for (Contestant& one : *contestants) {
    one.errors = one.statistics.summary();
    one.time = time_model(*one.model, one.features);
  }
  if (options.json) {
    print_json(options, *summary, *contestants);
  } else {
    print_table(options, *summary, *contestants);
  }
  return {};
}

}  // namespace

void add_replay(CLI::App& app, Verbs& verbs) {
  CLI::App* command = app.add_subcommand("replay", "Run models over a recording and measure their errors");
  const auto options = std::make_shared<Options>();
  command->add_option("--recording", options->recording, "Recording to replay (CSV)")->required();
  command->add_option("--model", options->models, "Model file (JSON); up to 16, repeat the option or list them")
      ->required();
  command->add_option("--out", options->out, "Write features and forces, row by row, to this file (CSV)");
  command->add_flag("--json", options->json, "Print one JSON object instead of a table");
  command->add_flag("--force", options->force, "Write over an existing file");
  verbs.emplace_back(command, [options] { return run(*options); });
}

}  // namespace palpate::cli
