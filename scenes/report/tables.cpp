#include "scenes/report/tables.h"

#include <cmath>
#include <limits>

#include "scenes/report/recommendation.h"

namespace palpate {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kPercent = 100.0;
constexpr double kMilli = 1e3;

double share(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : kNone;
}

void add_interval(std::vector<TableColumn>& columns, const std::string& key, const std::string& title, double scale,
                  int decimals) {
  columns.push_back({key, title, scale, decimals, true});
  columns.push_back({key + "_low", "", scale, decimals});
  columns.push_back({key + "_high", "", scale, decimals});
}

// `full`: those of a page's widest table; the CSV file always has all.
std::vector<TableColumn> error_columns(bool full) {
  std::vector<TableColumn> columns{{"contact_samples", full ? "samples" : ""}};
  add_interval(columns, "within_jnd", "within the JND [%]", kPercent, 2);
  add_interval(columns, "p99_error_over_jnd", "99 % of errors up to [JND]", 1.0, 2);
  add_interval(columns, "rms_error_N", "RMS [mN]", kMilli, TableColumn::kThreeDigits);
  add_interval(columns, "max_error_over_jnd", "worst [JND]", 1.0, 2);
  add_interval(columns, "max_error_N", "", kMilli, TableColumn::kThreeDigits);
  columns.push_back({"out_of_domain_share", full ? "away from the data [%]" : "", kPercent, 2});
  return columns;
}

void add_interval(std::vector<TableCell>& row, bool any, double value, const Interval& interval) {
  row.emplace_back(any ? value : kNone);
  row.emplace_back(any ? interval.low : kNone);
  row.emplace_back(any ? interval.high : kNone);
}

void add_errors(std::vector<TableCell>& row, const Evidence& errors) {
  const bool any = errors.samples > 0;
  row.emplace_back(errors.samples);
  add_interval(row, any, errors.within_jnd, errors.within_interval);
  add_interval(row, any, errors.p99_error_over_jnd, errors.p99_interval);
  add_interval(row, any, errors.rms_error_N, errors.rms_interval_N);
  add_interval(row, any, errors.max_error_over_jnd, errors.worst_interval);
  add_interval(row, any, errors.max_error_N, errors.max_interval_N);
  row.emplace_back(share(errors.out_of_domain_samples, errors.samples));
}

// Without intervals: nothing was resampled.
Evidence without_intervals(const ErrorSummary& errors) {
  Evidence evidence;
  static_cast<ErrorSummary&>(evidence) = errors;
  for (Interval* interval : {&evidence.within_interval, &evidence.p99_interval, &evidence.rms_interval_N,
                             &evidence.worst_interval, &evidence.max_interval_N}) {
    *interval = {kNone, kNone};
  }
  return evidence;
}

// A model that errs by the sensor's noise alone.
void add_floor(std::vector<TableCell>& row, const NoiseFloor& floor, std::uint64_t samples) {
  const Interval none{kNone, kNone};
  row.emplace_back(samples);
  add_interval(row, true, floor.within_jnd, none);
  add_interval(row, true, floor.p99_error_over_jnd, none);
  add_interval(row, true, floor.rms_error_N, none);
  add_interval(row, false, 0.0, none);
  add_interval(row, false, 0.0, none);
  row.emplace_back(kNone);
}

Table with_errors(const std::string& name, const std::string& caption, std::vector<TableColumn> columns, bool full) {
  const std::vector<TableColumn> errors = error_columns(full);
  columns.insert(columns.end(), errors.begin(), errors.end());
  return {name, caption, false, std::move(columns), {}};
}

std::string method_of(const ModelResult& model) {
  return model.plan.rung == Rung::no_force ? "none" : model.plan.request.method->name;
}

Table recordings_table(const ReportData& data) {
  Table table{"recordings",
              std::string(data.folds > 0
                              ? "There was no test recording: every one of these was tested by models that were "
                                "fitted to the others. "
                              : "") +
                  "No two have the same content, and no stretch of what was tested was trained on: the measured "
                  "forces were compared bit by bit. The noise of the force sensor decides what a perfect model could "
                  "have within the JND.",
              false,
              {{"role", "used to"},
               {"recording", "recording"},
               {"samples", "samples"},
               {"contact_samples", "in contact"},
               {"seconds", "length [s]"},
               {"rate_Hz", "rate [Hz]"},
               {"deepest_m", "deepest [mm]", kMilli},
               {"largest_force_N", "largest force [N]"},
               {"force_noise_N", "force noise [mN]", kMilli},
               {"noise_floor_within_jnd", "perfect model within the JND [%]", kPercent, 2},
               {"content_hash", ""}},
              {}};
  for (const RecordingFacts& facts : data.recordings) {
    table.rows.push_back({facts.role, facts.name, facts.samples, facts.contact_samples, facts.seconds, facts.rate_Hz,
                          facts.deepest_m, facts.largest_force_N, facts.noise.force_noise_N, facts.noise.within_jnd,
                          facts.content_hash});
  }
  return table;
}

// Moved figures beside those as recorded.
void add_moved_columns(Table& table) {
  table.columns.push_back({"surface_moved_within_jnd", "surface moved: within the JND [%]", kPercent, 2});
  table.columns.push_back({"surface_moved_p99_error_over_jnd", "99 % of errors up to [JND]", 1.0, 2});
  table.columns.push_back({"surface_moved_rms_error_N", "", kMilli});
  table.columns.push_back({"surface_moved_max_error_over_jnd", "", 1.0, 2});
  table.columns.push_back({"surface_moved_max_error_N", "", kMilli});
}

void add_moved(std::vector<TableCell>& row, const ErrorSummary& moved) {
  for (const double value : {moved.within_jnd, moved.p99_error_over_jnd, moved.rms_error_N, moved.max_error_over_jnd,
                             moved.max_error_N}) {
    row.emplace_back(moved.samples > 0 ? value : kNone);
  }
}

void add_floor_moved(std::vector<TableCell>& row, const NoiseFloor& floor) {
  for (const double value : {floor.within_jnd, floor.p99_error_over_jnd, floor.rms_error_N, kNone, kNone}) {
    row.emplace_back(value);
  }
}

std::uint64_t tested_samples(const ReportData& data) {
  return data.models.empty() ? 0 : data.models.front().pooled.samples;
}

Table ladder_table(const ReportData& data) {
  Table table = with_errors("ladder", "", {{"rung", "rung"}, {"model", "model"}}, false);
  add_moved_columns(table);
  table.columns.push_back({"tied", "tied with the best"});
  const ModelResult* best = nullptr;
  for (const ModelResult& model : data.models) {
    if (!model.plan.main || model.plan.rung == Rung::no_force) continue;
    if (best == nullptr || model.pooled.p99_error_over_jnd < best->pooled.p99_error_over_jnd) best = &model;
  }
  for (const ModelResult& model : data.models) {
    if (!model.plan.main) continue;
    std::vector<TableCell> row{std::string(rung_name(model.plan.rung)), model.plan.name};
    add_errors(row, model.pooled);
    add_moved(row, model.pooled_moved);
    row.emplace_back(std::string(best == &model ? "best" : best != nullptr && tied(model.pooled, best->pooled) ? "tied" : ""));
    table.rows.push_back(std::move(row));
  }
  std::vector<TableCell> row{std::string("floor"), std::string("a perfect model")};
  add_floor(row, data.pooled_floor, tested_samples(data));
  add_floor_moved(row, data.pooled_floor);
  row.emplace_back(std::string());
  table.rows.push_back(std::move(row));
  return table;
}

Table errors_table(const ReportData& data) {
  Table table = with_errors("speed_error",
                            "Every model over all test samples in contact, with 95 % intervals from resampled strokes. "
                            "Models whose intervals overlap are tied: the test does not tell them apart.",
                            {{"model", "model"}, {"recipe", "recipe"}, {"method", ""}, {"centres", "centres or nodes"}},
                            false);
  add_moved_columns(table);
  table.columns.push_back({"left_out_within_jnd", "left-out strokes: within the JND [%]", kPercent, 2});
  table.columns.push_back({"left_out_p99_error_over_jnd", ""});
  table.columns.push_back({"strokes", ""});
  table.columns.push_back({"blocks", ""});
  table.columns.push_back({"beyond_jnd_samples", ""});
  table.columns.push_back({"beyond_jnd_strokes", ""});
  for (const ModelResult& model : data.models) {
    std::vector<TableCell> row{model.plan.name, std::string(rung_key(model.plan.rung)), method_of(model),
                               static_cast<std::uint64_t>(model.size)};
    add_errors(row, model.pooled);
    add_moved(row, model.pooled_moved);
    row.emplace_back(model.left_out.samples > 0 ? model.left_out.within_jnd : kNone);
    row.emplace_back(model.left_out.samples > 0 ? model.left_out.p99_error_over_jnd : kNone);
    for (const std::uint64_t count : {model.pooled.strokes, model.pooled.blocks, model.pooled.beyond_samples,
                                      model.pooled.beyond_strokes}) {
      row.emplace_back(count);
    }
    table.rows.push_back(std::move(row));
  }
  std::vector<TableCell> row{std::string("a perfect model"), std::string("floor"), std::string("none"), kNone};
  add_floor(row, data.pooled_floor, tested_samples(data));
  add_floor_moved(row, data.pooled_floor);
  for (int i = 0; i < 6; ++i) row.emplace_back(kNone);
  table.rows.push_back(std::move(row));
  return table;
}

Table times_table(const ReportData& data) {
  Table table{"speed_error_times",
              "Times on this machine: compare ratios. The fit times leave out what all methods share (reading, trend, "
              "features, reduction); a grid includes the direct fit that fills it.",
              true,
              {{"model", "model"},
               {"evaluation_ns_median", "evaluation, median [ns]"},
               {"evaluation_ns_p99", "99th percentile [ns]"},
               {"fit_seconds", "fit [s]"}},
              {}};
  for (const ModelResult& model : data.models) {
    if (model.plan.rung == Rung::no_force) continue;
    const bool timed = model.time.measured;
    table.rows.push_back({model.plan.name, timed ? model.time.median_ns : kNone, timed ? model.time.p99_ns : kNone,
                          model.fit_seconds});
  }
  return table;
}

Table per_recording_table(const ReportData& data) {
  const bool several = data.test_names.size() > 1;
  Table table = with_errors("per_recording",
                            several ? "The same models, test recording by test recording: a model that is good on one "
                                      "and bad on another has not learnt the material."
                                    : "",
                            {{"recording", "recording"},
                             {"surface_offset_m", "surface at [mm]", kMilli, 3},
                             {"model", "model"}},
                            false);
  add_moved_columns(table);
  for (std::size_t r = 0; r < data.test_names.size(); ++r) {
    const double offset_m = r < data.surface_offset_m.size() ? data.surface_offset_m[r] : kNone;
    for (const ModelResult& model : data.models) {
      if (!model.plan.main) continue;
      std::vector<TableCell> row{data.test_names[r], offset_m, model.plan.name};
      add_errors(row, model.per_recording[r]);
      add_moved(row, r < model.per_recording_moved.size() ? model.per_recording_moved[r] : Evidence{});
      table.rows.push_back(std::move(row));
    }
    if (r >= data.floors.size()) continue;
    std::vector<TableCell> row{data.test_names[r], offset_m, std::string("a perfect model")};
    add_floor(row, data.floors[r], data.models.empty() ? 0 : data.models.front().per_recording[r].samples);
    add_floor_moved(row, data.floors[r]);
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table bins_table(const ReportData& data) {
  Table table{"force_bins",
              "",
              false,
              {{"model", ""},
               {"force_from_N", ""},
               {"force_to_N", ""},
               {"count", ""},
               {"mean_abs_error_N", ""},
               {"std_abs_error_N", ""},
               {"max_abs_error_N", ""},
               {"mean_force_N", ""},
               {"mean_error_over_jnd", ""},
               {"std_error_over_jnd", ""},
               {"max_error_over_jnd", ""}},
              {}};
  for (const ModelResult& model : data.models) {
    if (!model.plan.main) continue;
    for (const ErrorBin& bin : model.bins) {
      table.rows.push_back({model.plan.name, bin.force_from_N, bin.force_to_N, bin.count, bin.mean_abs_error_N,
                            bin.std_abs_error_N, bin.max_abs_error_N, bin.mean_force_N, bin.mean_error_over_jnd,
                            bin.std_error_over_jnd, bin.max_error_over_jnd});
    }
  }
  return table;
}

Table coverage_table(const ReportData& data) {
  Table table = with_errors("coverage_errors",
                            "Near the training data and away from it, as " + data.coverage.reference + " sees it. Away from the data every "
                            "model falls back to the trend, so an error there asks for a recording, not for another "
                            "method.",
                            {{"model", "model"}, {"where", "where"}}, true);
  for (const CoverageErrors& errors : data.coverage.errors) {
    for (const bool inside : {true, false}) {
      if ((inside ? errors.inside : errors.outside).samples == 0) continue;
      std::vector<TableCell> row{errors.model, std::string(inside ? "near the data" : "away from it")};
      add_errors(row, without_intervals(inside ? errors.inside : errors.outside));
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

Table seeds_table(const ReportData& data) {
  Table table = with_errors("repeatability", "", {{"model", "model"}, {"seed", "seed"}}, true);
  for (const SeedResult& seed : data.seeds) {
    std::vector<TableCell> row{seed.model.name, seed.seed};
    add_errors(row, without_intervals(seed.errors));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string joined(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += (text.empty() ? "" : "; ") + note;
  return text;
}

Table health_table(const ReportData& data) {
  Table table{"fit_health",
              "Rank below unknowns: the data did not decide, and the shortest solution was taken. A condition above "
              "1e12 means that weights are large and cancel; errors above then say whether it hurt.",
              false,
              {{"fold", "fold"},
               {"model", "model"},
               {"training_samples", "samples"},
               {"sites", "after reduction"},
               {"unknowns", "unknowns"},
               {"rank", "rank"},
               {"condition", "condition"},
               {"smoothing", "smoothing"},
               {"residual_rms", "residual [JND]"},
               {"training_within_jnd", "training within the JND [%]", kPercent, 2},
               {"notes", "notes"}},
              {}};
  for (const ModelResult& model : data.models) {
    for (const FitHealth& health : model.health) {
      const FitReport& report = health.report;
      const bool direct = model.plan.request.method->can_take(kTakesSolver);
      table.rows.push_back({static_cast<std::uint64_t>(health.fold + 1), model.plan.name, health.training_samples,
                            health.sites, static_cast<std::uint64_t>(report.columns),
                            static_cast<std::uint64_t>(report.rank), report.condition,
                            direct ? report.smoothing : kNone, report.residual_rms, health.training_within_jnd,
                            joined(report.notes)});
    }
  }
  return table;
}

Table sites_time_table(const ReportData& data) {
  Table table{"fit_time_sites_times", "", true, {{"model", ""}, {"sites", ""}, {"fit_seconds", ""}}, {}};
  for (const SitesTime& time : data.sites_time) table.rows.push_back({time.model, time.sites, time.seconds});
  return table;
}

Table dimension_table(const ReportData& data) {
  Table table{"dimension_times",
              "",
              true,
              {{"dimension", ""}, {"sites", ""}, {"grid_nodes", ""}, {"direct_seconds", ""}, {"grid_seconds", ""},
               {"greedy_seconds", ""}},
              {}};
  for (const DimensionTime& time : data.dimension_time) {
    table.rows.push_back({static_cast<std::uint64_t>(time.dimension), data.dimension_sites, time.nodes,
                          time.direct_seconds, time.grid_seconds, time.greedy_seconds});
  }
  return table;
}

std::vector<Table> facts_tables(const ReportData& data) {
  const ModelFacts& facts = data.facts;
  Table values{"model_facts",
               "What " + facts.model + " says of the material.",
               false,
               {{"quantity", "quantity"}, {"value", "value"}, {"unit", "unit"}, {"meaning", "meaning"}},
               facts.values};
  Table features{"model_features",
                 "What it is given, in SI, with the range in training.",
                 false,
                 {{"feature", "feature"}, {"lowest", "lowest"}, {"highest", "highest"}},
                 facts.features};
  Table worth{"feature_worth",
              "What every feature is worth: the trend's RMS error over the JND on training strokes left out, with it "
              "and without it.",
              false,
              {{"feature", "feature"},
               {"taken", "taken"},
               {"error_over_jnd_with", "error with it [JND]"},
               {"error_over_jnd_without", "without it [JND]"}},
              {}};
  for (const FeatureWorth& one : data.worth) {
    worth.rows.push_back({one.name, std::string(one.taken ? "yes" : "no"), one.error_with, one.error_without});
  }
  Table curve{"model_depth",
              "",
              false,
              {{"depth_m", ""},
               {"elastic_N", ""},
               {"elastic_stiffness_N_per_m", ""},
               {"instantaneous_stiffness_N_per_m", ""},
               {"viscosity_slow_Ns_per_m", ""},
               {"viscosity_fast_Ns_per_m", ""}},
              {}};
  for (const auto& row : facts.depth) curve.rows.emplace_back(row.begin(), row.end());
  Table spectrum{"model_relaxation", "", false, {{"relaxation_time_s", ""}, {"stiffness_N_per_m", ""}}, {}};
  for (const auto& row : facts.spectrum) spectrum.rows.emplace_back(row.begin(), row.end());
  return {values, features, worth, curve, spectrum};
}

}  // namespace

std::vector<Table> make_tables(const ReportData& data) {
  std::vector<Table> tables{recordings_table(data), ladder_table(data), errors_table(data),   times_table(data),
                            per_recording_table(data), bins_table(data),  coverage_table(data),
                            seeds_table(data),      health_table(data),   sites_time_table(data),
                            dimension_table(data)};
  for (Table& table : facts_tables(data)) tables.push_back(std::move(table));
  if (data.hard_cases) tables.push_back(*data.hard_cases);
  return tables;
}

Table hard_case_table(const std::vector<HardCaseResult>& results) {
  Table table{"hard_cases",
              "Every method on data that break numerics and on motions far from the training; made up, the same in "
              "every report. Safe: finite and bounded everywhere, or refused with a message. Errors are over what was "
              "held out.",
              false,
              {{"case", "case"},
               {"method", "method"},
               {"safe", "safe"},
               {"within_jnd", "within the JND [%]", kPercent, 1},
               {"worst_over_jnd", "worst [JND]"},
               {"condition", "condition"},
               {"smoothing", "smoothing"},
               {"residual", "residual [JND]"},
               {"outcome", "outcome"}},
              {}};
  for (const HardCaseResult& result : results) {
    table.rows.push_back({result.name, result.method, std::string(result.safe ? "yes" : "no"), result.within_jnd,
                          result.worst_over_jnd, result.condition, result.smoothing, result.residual, result.outcome});
  }
  return table;
}

}  // namespace palpate
