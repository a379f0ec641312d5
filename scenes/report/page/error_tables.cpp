// The tables of errors: the ladder, every model, recording by recording, near the data and
// away from them, over seeds.
#include "scenes/report/page/tables.h"

namespace palpate {
namespace {

double share(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : kNoNumber;
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
  add_interval(columns, "within_jnd", "within the JND [%]", kInPercent, 2);
  add_interval(columns, "p99_error_over_jnd", "99 % of errors up to [JND]", 1.0, 2);
  add_interval(columns, "rms_error_N", "RMS [mN]", kInMilli, TableColumn::kThreeDigits);
  add_interval(columns, "max_error_over_jnd", "worst [JND]", 1.0, 2);
  add_interval(columns, "max_error_N", "", kInMilli, TableColumn::kThreeDigits);
  columns.push_back({"out_of_domain_share", full ? "away from the data [%]" : "", kInPercent, 2});
  return columns;
}

void add_interval(std::vector<TableCell>& row, bool any, double value, const Interval& interval) {
  row.emplace_back(any ? value : kNoNumber);
  row.emplace_back(any ? interval.low : kNoNumber);
  row.emplace_back(any ? interval.high : kNoNumber);
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
    *interval = {kNoNumber, kNoNumber};
  }
  return evidence;
}

// A model that errs by the sensor's noise alone.
void add_floor(std::vector<TableCell>& row, const NoiseFloor& floor, std::uint64_t samples) {
  const Interval none{kNoNumber, kNoNumber};
  row.emplace_back(samples);
  add_interval(row, true, floor.within_jnd, none);
  add_interval(row, true, floor.p99_error_over_jnd, none);
  add_interval(row, true, floor.rms_error_N, none);
  add_interval(row, false, 0.0, none);
  add_interval(row, false, 0.0, none);
  row.emplace_back(kNoNumber);
}

Table with_errors(const std::string& name, const std::string& caption, std::vector<TableColumn> columns, bool full) {
  const std::vector<TableColumn> errors = error_columns(full);
  columns.insert(columns.end(), errors.begin(), errors.end());
  return {name, caption, false, std::move(columns), {}};
}

std::string method_of(const ModelResult& model) {
  return model.plan.rung == Rung::no_force ? "none" : model.plan.request.method->name;
}

// Moved figures beside those as recorded.
void add_moved_columns(Table& table) {
  table.columns.push_back({"surface_moved_within_jnd", "surface moved: within the JND [%]", kInPercent, 2});
  table.columns.push_back({"surface_moved_p99_error_over_jnd", "99 % of errors up to [JND]", 1.0, 2});
  table.columns.push_back({"surface_moved_rms_error_N", "", kInMilli});
  table.columns.push_back({"surface_moved_max_error_over_jnd", "", 1.0, 2});
  table.columns.push_back({"surface_moved_max_error_N", "", kInMilli});
}

void add_moved(std::vector<TableCell>& row, const ErrorSummary& moved) {
  for (const double value : {moved.within_jnd, moved.p99_error_over_jnd, moved.rms_error_N, moved.max_error_over_jnd,
                             moved.max_error_N}) {
    row.emplace_back(moved.samples > 0 ? value : kNoNumber);
  }
}

void add_floor_moved(std::vector<TableCell>& row, const NoiseFloor& floor) {
  for (const double value : {floor.within_jnd, floor.p99_error_over_jnd, floor.rms_error_N, kNoNumber, kNoNumber}) {
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
  table.columns.push_back({"left_out_within_jnd", "left-out strokes: within the JND [%]", kInPercent, 2});
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
    row.emplace_back(model.left_out.samples > 0 ? model.left_out.within_jnd : kNoNumber);
    row.emplace_back(model.left_out.samples > 0 ? model.left_out.p99_error_over_jnd : kNoNumber);
    for (const std::uint64_t count : {model.pooled.strokes, model.pooled.blocks, model.pooled.beyond_samples,
                                      model.pooled.beyond_strokes}) {
      row.emplace_back(count);
    }
    table.rows.push_back(std::move(row));
  }
  std::vector<TableCell> row{std::string("a perfect model"), std::string("floor"), std::string("none"), kNoNumber};
  add_floor(row, data.pooled_floor, tested_samples(data));
  add_floor_moved(row, data.pooled_floor);
  for (int i = 0; i < 6; ++i) row.emplace_back(kNoNumber);
  table.rows.push_back(std::move(row));
  return table;
}

Table per_recording_table(const ReportData& data) {
  const bool several = data.test_names.size() > 1;
  Table table = with_errors("per_recording",
                            several ? "The same models, test recording by test recording: a model that is good on one "
                                      "and bad on another has not learnt the material."
                                    : "",
                            {{"recording", "recording"},
                             {"surface_offset_m", "surface at [mm]", kInMilli, 3},
                             {"model", "model"}},
                            false);
  add_moved_columns(table);
  for (std::size_t r = 0; r < data.test_names.size(); ++r) {
    const double offset_m = r < data.surface_offset_m.size() ? data.surface_offset_m[r] : kNoNumber;
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

}  // namespace

std::vector<Table> error_tables(const ReportData& data) {
  return {ladder_table(data), errors_table(data), per_recording_table(data), coverage_table(data), seeds_table(data)};
}

}  // namespace palpate
