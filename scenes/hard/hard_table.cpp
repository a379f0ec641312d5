#include "scenes/hard/hard_table.h"

#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "scenes/report/publish.h"

namespace palpate {
namespace {

std::string percent(double share) { return at_most_three_decimals(0.1 * std::floor(1000.0 * share)) + " %"; }

// The numbers of a cell. JSON has null for those that do not apply.
double known(double value, bool applies) { return applies ? value : kNoNumber; }

// A fit is a fifth of a second; a trial of all its models takes as long as one of them.
Result<HardRow> run_case(HardCase one, const FitControl& control) {
  const HardTrial trial = one.build();
  HardRow row{std::move(one), {}};
  for (const ModelPlan& plan : hard_plans()) {
    auto fitted = trial.training->fit(plan, control);
    if (!fitted) return fitted.error();
    row.cells.push_back({std::move(*fitted)});
  }
  parallel_for(static_cast<int>(row.cells.size()), [&](int i) {
    HardCell& cell = row.cells[static_cast<std::size_t>(i)];
    if (cell.model) cell.figures = trial.measure(cell.model);
  });
  for (std::size_t k = 0; k < row.cells.size(); ++k)
    row.cells[k].missed = missed_by(row.cells[k], row.of.expectation(hard_plans()[k]));
  return row;
}

// "≥ 99.0 %, error ≤ 0.300 N, ..."
std::string expectation_text(const HardExpectation& expected) {
  if (!expected.refusal.empty()) return "refused: \"" + expected.refusal + "\"";
  std::string text;
  const auto add = [&](double most, double scale, const char* what, const char* unit) {
    if (std::isfinite(most)) text += (text.empty() ? "" : ", ") + (what + three_digits(scale * most)) + unit;
  };
  if (expected.within_jnd > 0.0) text = "≥ " + percent(expected.within_jnd);
  add(expected.worst_error_N, 1.0, "error ≤ ", " N");
  add(expected.worst_step_N, 1e3, "step ≤ ", " mN");
  add(expected.energy_J, 1e3, "energy ≤ ", " mJ");
  return text;
}

// One row for each cell, with every figure.
Table cells_table(const std::vector<HardRow>& rows) {
  Table table{"cells", true};
  for (const HardRow& row : rows) {
    for (std::size_t k = 0; k < row.cells.size(); ++k) {
      const HardCell& cell = row.cells[k];
      table.begin_row();
      table.add({"case", "case"}, row.of.name);
      table.add({"kind", ""}, kHardKinds[static_cast<std::size_t>(row.of.kind)]);
      table.add({"method", "method"}, plan_name(hard_plans()[k]));
      table.add({"status", "status"}, cell.refusal.empty() ? "fitted" : "refused");
      table.add({"reason", "reason"}, cell.refusal);
      table.add({"expected", "as expected"}, cell.missed.empty());
      table.add({"missed", "missed"}, cell.missed);
      table.add({"rank", "rank"}, known(static_cast<double>(cell.rank), cell.rank > 0));
      table.add({"condition_number", "condition"}, known(cell.condition_number, cell.condition_number > 0.0));
      table.add({"within_jnd", "≤ JND [%]", kInPercent, 2}, cell.figures.within_jnd);
      table.add({"worst_error_N", "worst [N]"}, cell.figures.worst_error_N);
      table.add({"worst_step_N", "step [mN]", kInMilli}, cell.figures.worst_step_N);
      table.add({"energy_J", "energy [mJ]", kInMilli}, cell.figures.energy_J);
      table.add({"seconds", "fit [s]"}, cell.seconds);
    }
  }
  return table;
}

// Rank and condition number of the fit.
std::string numerics_text(const HardCell& cell) {
  if (cell.rank == 0) return "–";
  return std::to_string(cell.rank) + " · " + general(cell.condition_number, 1);
}

// The cases of one kind: a row for each, a column for each method, its rank and condition number below.
Table marks_table(const std::vector<HardRow>& rows, std::size_t kind) {
  Table table{kHardKinds[kind]};
  const std::vector<ModelPlan> plans = hard_plans();
  for (const HardRow& row : rows) {
    if (static_cast<std::size_t>(row.of.kind) != kind) continue;
    table.begin_row();
    table.add({"case", "case", 1.0, TableColumn::kThreeDigits, 1}, row.of.name);
    table.add({"why", ""}, row.of.why);
    table.add({"force", "expected on the force, with the trend", 1.0, TableColumn::kThreeDigits, 1},
              expectation_text(row.of.expected.at("force")));
    table.add({"corrected", ""}, expectation_text(row.of.expected.at("corrected")));
    for (std::size_t k = 0; k < plans.size(); ++k) {
      table.add({plan_name(plans[k]), plan_name(plans[k]), 1.0, TableColumn::kThreeDigits, 1}, cell_text(row.cells[k]));
      table.add({plan_name(plans[k]) + " rank and condition", ""}, numerics_text(row.cells[k]));
    }
  }
  return table;
}

std::string list_html(const std::vector<std::string>& lines) {
  std::string html;
  for (const std::string& line : lines) html += "<li>" + escape_html(line) + "</li>\n";
  return html.empty() ? "" : "<h2>Not as expected</h2>\n<ul>\n" + html + "</ul>\n";
}

}  // namespace

std::vector<ModelPlan> hard_plans() {
  std::vector<ModelPlan> plans = all_plans();
  std::erase_if(plans, [](const ModelPlan& plan) {
    return plan.base == Base::trend && plan.method != &kTrendMethod && plan.method != ModelPlan{}.method;
  });
  return plans;
}

std::string missed_by(const HardCell& cell, const HardExpectation& expected) {
  if (!expected.refusal.empty()) {
    if (cell.refusal.empty()) return "fitted, expected a refusal";
    return cell.refusal.find(expected.refusal) != std::string::npos
               ? ""
               : "refused with another reason, expected \"" + expected.refusal + "\"";
  }
  if (!cell.refusal.empty()) return "refused, expected a fit";
  const HardFigures& found = cell.figures;
  if (found.within_jnd < expected.within_jnd)
    return percent(found.within_jnd) + " within the JND, expected at least " + percent(expected.within_jnd);
  const auto above = [](double value, double most, const char* what, const char* unit) {
    return what + three_digits(value) + unit + ", expected at most " + three_digits(most) + unit;
  };
  if (found.worst_error_N > expected.worst_error_N)
    return above(found.worst_error_N, expected.worst_error_N, "an error of ", " N");
  if (found.worst_step_N > expected.worst_step_N)
    return above(found.worst_step_N, expected.worst_step_N, "a step of ", " N");
  if (found.energy_J > expected.energy_J)
    return above(1e3 * found.energy_J, 1e3 * expected.energy_J, "energy of ", " mJ");
  return "";
}

Result<std::vector<HardRow>> run_hard(const FitControl& control) {
  auto cases = hard_cases();
  if (!cases) return cases.error();
  std::vector<HardRow> rows;
  for (HardCase& one : *cases) {
    const double done = static_cast<double>(rows.size()) / static_cast<double>(cases->size());
    if (!control.may_continue(done)) return interrupted();
    auto row = run_case(std::move(one), control.at(done));
    if (!row) return row.error();
    rows.push_back(std::move(*row));
  }
  return rows;
}

std::vector<std::string> missed_cells(const std::vector<HardRow>& rows) {
  std::vector<std::string> missed;
  const std::vector<ModelPlan> plans = hard_plans();
  for (const HardRow& row : rows) {
    for (std::size_t k = 0; k < plans.size(); ++k)
      if (!row.cells[k].missed.empty())
        missed.push_back(row.of.name + ", " + plan_name(plans[k]) + ": " + row.cells[k].missed);
  }
  return missed;
}

std::string hard_answer(const std::vector<HardRow>& rows) {
  std::size_t cells = 0, refused = 0;
  for (const HardRow& row : rows) {
    cells += row.cells.size();
    refused += static_cast<std::size_t>(
        std::ranges::count_if(row.cells, [](const HardCell& c) { return !c.refusal.empty(); }));
  }
  const std::size_t missed = missed_cells(rows).size();
  return std::to_string(cells - missed) + " of " + std::to_string(cells) +
         " cells are as expected: " + std::to_string(hard_plans().size()) + " methods on " +
         std::to_string(rows.size()) + " hard cases; " + std::to_string(refused) + " fits were refused.";
}

std::string cell_text(const HardCell& cell) {
  const std::string mark = cell.missed.empty() ? "✓ " : "✗ ";
  if (!cell.refusal.empty()) return mark + "refused";
  return mark +
         (std::isnan(cell.figures.within_jnd) ? "–" : fixed(0.1 * std::floor(1000.0 * cell.figures.within_jnd), 1));
}

nlohmann::ordered_json hard_json(const std::vector<HardRow>& rows) {
  return {{"cells", table_json(cells_table(rows))}};
}

Status write_hard_page(const std::vector<HardRow>& rows, const HardPage& page, const FitControl& control) {
  auto folder = ReportFolder::create(page.out, page.force);
  if (!folder) return folder.error();
  std::vector<Table> tables;
  for (std::size_t kind = 0; kind < std::size(kHardKinds); ++kind) tables.push_back(marks_table(rows, kind));
  tables.push_back(cells_table(rows));
  nlohmann::ordered_json report{{"format", "palpate-hard"}, {"version", 1}, {"answer", hard_answer(rows)}};
  report.update(hard_json(rows));
  return write_report(*folder, "hard.html", tables, {},
                      {{"answer", escape_html(hard_answer(rows))},
                       {"missed", list_html(missed_cells(rows))},
                       {"origin", escape_html(page.origin)}},
                      report, control);
}

}  // namespace palpate
