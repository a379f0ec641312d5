#include "scenes/report/table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/text.h"
#include "scenes/report/publish.h"

namespace palpate {
namespace {

constexpr int kThree = TableColumn::kThreeDigits;
constexpr const char* kNothing = "–";

const char* yes_or_no(bool value) { return value ? "yes" : "no"; }

std::string quoted_if_needed(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted(1, '"');
  for (const char letter : text) {
    if (letter == '"') quoted += '"';
    quoted += letter;
  }
  return quoted + '"';
}

std::string csv_cell(const TableCell& cell) {
  if (cell.is_string()) return quoted_if_needed(cell.get<std::string>());
  if (cell.is_number_integer() || cell.is_boolean()) return cell.dump();
  return std::isfinite(cell.get<double>()) ? shortest(cell.get<double>()) : "";
}

std::string shown(const TableCell& cell, const TableColumn& column) {
  if (cell.is_string()) return cell.get<std::string>();
  if (cell.is_boolean()) return yes_or_no(cell.get<bool>());
  if (cell.is_number_integer()) return with_thousands(cell.dump());
  const double value = cell.get<double>() * column.scale;
  if (!std::isfinite(value)) return kNothing;
  return column.decimals == TableColumn::kThreeDigits ? three_digits(value)
                                                      : with_thousands(fixed(value, column.decimals));
}

// The small text below the cell `first - 1`: the next value, or the next two as an interval.
std::string under_html(const std::vector<TableCell>& row, std::size_t first, const TableColumn& column) {
  if (column.under == 0) return {};
  const std::string low = shown(row[first], column);
  const std::string high = column.under == 2 ? shown(row[first + 1], column) : "";
  if (low == kNothing || high == kNothing) return {};
  return "<small>" + escape_html(low) + (high.empty() ? "" : "–" + escape_html(high)) + "</small>";
}

bool is_text(const Table& table, std::size_t column) {
  return !table.rows.empty() &&
         std::ranges::all_of(table.rows, [&](const auto& row) { return row[column].is_string(); });
}

// A figure over the seeds of a method that draws random numbers.
TableCell of_seeds(const ModelResult& one, double value) { return one.seeds > 1 ? value : kNoNumber; }

Table models_table(const ReportData& data) {
  Table table{"models"};
  for (const ModelResult& one : data.models) {
    const UnitErrors& errors = one.errors;
    const Interval p99 = errors.p99_interval();
    const PairedDifference difference = paired_difference(errors, data.models[data.choice.best].errors);
    table.begin_row();
    table.add({"model", "model"}, one.name);
    table.add({"size", "size"}, one.size);
    table.add({"seeds", "seeds"}, one.seeds);
    table.add({"seed", ""}, one.plan ? one.plan->seed : 0);
    table.add({"contact_samples", "samples"}, errors.samples);
    table.add({"within_jnd", "≤ JND [%], seeds", kInPercent, 2, 2}, errors.within_jnd);
    table.add({"within_jnd_least", "", kInPercent, 2}, of_seeds(one, one.within_range.low));
    table.add({"within_jnd_greatest", "", kInPercent, 2}, of_seeds(one, one.within_range.high));
    table.add({"within_at_least", "at least [%]", kInPercent, 2}, errors.within_at_least());
    table.add({"p99_error_over_jnd", "99 % error [JND], 95 %", 1.0, kThree, 2}, errors.p99_error_over_jnd);
    table.add({"p99_error_over_jnd_low", ""}, p99.low);
    table.add({"p99_error_over_jnd_high", ""}, p99.high);
    table.add({"p99_least", "seeds from"}, of_seeds(one, one.p99_range.low));
    table.add({"p99_greatest", "to"}, of_seeds(one, one.p99_range.high));
    table.add({"difference_p99", "minus the lowest, 95 %", 1.0, kThree, 2}, difference.p99);
    table.add({"difference_p99_low", ""}, difference.interval.low);
    table.add({"difference_p99_high", ""}, difference.interval.high);
    table.add({"rms_error_N", "RMS [mN]", kInMilli}, errors.rms_error_N);
    table.add({"max_error_N", "worst [mN]", kInMilli}, errors.max_error_N);
    table.add({"max_error_over_jnd", "worst [JND]"}, errors.max_error_over_jnd);
    table.add({"units", errors.units_are_recordings ? "recordings" : "strokes"}, errors.units());
    table.add({"beyond_units", "beyond"}, errors.units_above_jnd);
    table.add({"out_of_domain_samples", ""}, errors.out_of_domain_samples);
    table.add({"moved_within_jnd", "moved: ≤ JND [%]", kInPercent, 2}, one.moved.within_jnd);
    table.add({"moved_p99_error_over_jnd", "99 % [JND]"}, one.moved.p99_error_over_jnd);
    table.add({"moved_rms_error_N", "RMS [mN]", kInMilli}, one.moved.rms_error_N);
    table.add({"bound_95_held", "≤ bound [%], moved", kInPercent, 1, 1}, one.bound.coverage);
    table.add({"bound_95_held_moved", "", kInPercent, 1}, one.bound_moved.coverage);
    table.add({"median_bound_N", ""}, one.bound.median_N);
    const bool wide = one.bound.has_bounds() && !std::isfinite(one.bound.median_over_jnd);
    table.add({"median_bound_over_jnd", "bound [JND]"},
              wide ? TableCell("not known") : TableCell(one.bound.median_over_jnd));
  }
  return table;
}

Table times_table(const ReportData& data) {
  Table table{"times", true};
  for (const ModelResult& one : data.models) {
    if (!one.time.measured) continue;
    table.begin_row();
    table.add({"model", "model"}, one.name);
    table.add({"tick_ns", "tick [ns]", 1.0, 0, 2}, one.time.tick.median_ns);
    table.add({"tick_low_ns", "", 1.0, 0}, one.time.tick.low_ns);
    table.add({"tick_high_ns", "", 1.0, 0}, one.time.tick.high_ns);
    table.add({"tick_p99_ns", "p99 [ns]", 1.0, 0}, one.time.tick.p99_ns);
    table.add({"evaluation_ns", "evaluation [ns]", 1.0, 0}, one.time.evaluation.median_ns);
    table.add({"evaluation_p99_ns", "p99 [ns]", 1.0, 0}, one.time.evaluation.p99_ns);
    table.add({"fit_seconds", "fit [s]"}, one.fit_seconds);
  }
  return table;
}

Table recordings_table(const ReportData& data) {
  Table table{"recordings"};
  const RecordingSet& set = data.recordings;
  for (std::size_t i = 0; i < set.all.size(); ++i) {
    const auto& [name, columns, rows] = set.all[i]->recording;
    const double seconds = rows.back().time_s - rows.front().time_s;
    char hash[24];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(set.all[i]->content_hash));
    table.begin_row();
    table.add({"role", "role"}, i >= set.trained ? "test" : set.is_tested(i) ? "both" : "train");
    table.add({"name", "recording"}, name);
    table.add({"samples", "samples"}, rows.size());
    table.add({"contact_samples", "in contact"}, std::ranges::count_if(rows, is_pressed));
    table.add({"seconds", "[s]"}, seconds);
    table.add({"rate_Hz", "[Hz]"}, static_cast<double>(rows.size() - 1) / seconds);
    table.add({"deepest_m", "deepest [mm]", kInMilli},
              std::ranges::max_element(rows, {}, &RecordingRow::position_m)->position_m);
    table.add({"largest_force_N", "largest [N]"}, largest_force_N(set.all[i]->recording));
    table.add({"force_noise_N", "force noise [mN]", kInMilli}, set.all[i]->force_noise_N);
    table.add({"accelerometer", "accelerometer"}, yes_or_no(columns.acceleration));
    table.add({"content_hash", ""}, hash);
  }
  return table;
}

Table bins_table(const ReportData& data) {
  Table table{"force_bins"};
  for (const ModelResult& one : data.models) {
    for (const ForceBin& bin : one.errors.bins) {
      if (!one.plan || bin.force_N.count() == 0) continue;
      table.begin_row();
      table.add({"model", ""}, one.name);
      table.add({"force_from_N", ""}, bin.force_from_N);
      table.add({"force_to_N", ""}, bin.force_to_N);
      table.add({"count", ""}, bin.force_N.count());
      table.add({"mean_force_N", ""}, bin.force_N.mean());
      table.add_moments("abs_error_N", bin.error_N);
      table.add_moments("error_over_jnd", bin.over_jnd);
    }
  }
  return table;
}

Table gains_table(const ReportData& data) {
  Table table{"features"};
  for (const PartGain& one : data.gains) {
    table.begin_row();
    table.add({"feature", "feature"}, one.name);
    table.add({"weight_above_0", "weight above 0"}, yes_or_no(one.taken));
    table.add({"error_over_jnd_with", "cross-validated error with it [JND]"}, one.error_with);
    table.add({"error_over_jnd_without", "without"}, one.error_without);
  }
  return table;
}

// The name, and those of the other main models with the same forces.
std::string name_with_same(const ModelResult& model) {
  std::string name = model.name;
  for (const std::string& other : model.same) {
    if (const auto plan = parse_plan(other); plan && is_main(*plan)) name += " = " + other;
  }
  return name;
}

}  // namespace

std::string table_csv(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i > 0) text.push_back(',');
    text += table.columns[i].key;
  }
  text.push_back('\n');
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {  // a row without cells is a blank line
      if (i > 0) text.push_back(',');
      text += csv_cell(row[i]);
    }
    text.push_back('\n');
  }
  return text;
}

nlohmann::ordered_json table_json(const Table& table) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& row : table.rows) {
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < row.size(); ++i) object[table.columns[i].key] = row[i];  // not finite: null
    list.push_back(std::move(object));
  }
  return list;
}

std::vector<std::vector<std::string>> table_text(const Table& table) {
  std::vector<std::vector<std::string>> lines(table.rows.size() + 1);
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].title.empty()) continue;
    lines[0].push_back(table.columns[i].title);
    for (std::size_t row = 0; row < table.rows.size(); ++row)
      lines[row + 1].push_back(shown(table.rows[row][i], table.columns[i]));
  }
  return lines;
}

std::string table_html(const Table& table) {
  std::string html = "<div class=\"table\"><table>\n<thead><tr>";
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].title.empty()) continue;
    html += is_text(table, i) ? "<th class=\"text\">" : "<th>";
    html += escape_html(table.columns[i].title) + "</th>";
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const TableColumn& column = table.columns[i];
      if (column.title.empty()) continue;
      html += is_text(table, i) ? "<td class=\"text\">" : "<td>";
      html += escape_html(shown(row[i], column)) + under_html(row, i + 1, column) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

Table headline_table(const ReportData& data) {
  Table table{"headline"};
  for (const std::size_t i : headline_models(data)) {
    const ModelResult& one = data.models[i];
    const UnitErrors& errors = one.errors;
    const Interval interval = errors.p99_interval();
    const auto time = [&](double time_ns) { return one.time.measured ? time_ns : kNoNumber; };
    table.begin_row();
    table.add({"", "model"}, name_with_same(one));
    table.add({"", "centres"}, one.size);
    table.add({"", "RMS [mN]", kInMilli}, errors.rms_error_N);
    table.add({"", "within JND [%]", kInPercent, 2, 2}, std::floor(1e4 * errors.within_jnd) / 1e4);
    table.add({"", "", kInPercent, 2}, of_seeds(one, one.within_range.low));
    table.add({"", "", kInPercent, 2}, of_seeds(one, one.within_range.high));
    table.add({"", "99 % error [JND]", 1.0, kThree, 2}, errors.p99_error_over_jnd);
    table.add({}, interval.low);
    table.add({}, interval.high);
    table.add({"", "worst [JND]"}, errors.max_error_over_jnd);
    table.add({"", "tick [ns]", 1.0, 0, 2}, time(one.time.tick.median_ns));
    table.add({"", "", 1.0, 0}, time(one.time.tick.low_ns));
    table.add({"", "", 1.0, 0}, time(one.time.tick.high_ns));
    const double above = errors.p99_error_over_jnd - data.models[data.choice.best].errors.p99_error_over_jnd;
    table.add({"", "above lowest [JND]"}, i == data.choice.recommended ? "recommended" : "+" + three_digits(above));
  }
  return table;
}

std::vector<Table> make_tables(const ReportData& data) {
  return {models_table(data), recordings_table(data), bins_table(data), gains_table(data), times_table(data)};
}

}  // namespace palpate
