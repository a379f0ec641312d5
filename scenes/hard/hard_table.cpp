#include <algorithm>
#include <cmath>

#include "engine/base/text.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/hard/hard.h"
#include "scenes/report/publish.h"

namespace palpate {
namespace {

// The numbers of a cell. JSON has null for those that do not apply.
double known(double value, bool applies) { return applies ? value : kNoNumber; }

// A fit is a fifth of a second; a trial of all its models takes as long as one of them.
Result<HardRow> run_case(HardCase one, const FitControl& control) {
  const HardTrial trial = one.build();
  HardRow row{std::move(one), {}};
  const std::vector<HardMethod> methods = hard_methods();
  for (const HardMethod& method : methods) {
    auto fitted = trial.training->fit(method, control);
    if (!fitted) return fitted.error();
    row.cells.push_back({std::move(*fitted)});
  }
  parallel_for(static_cast<int>(row.cells.size()), [&](int i) {
    HardCell& cell = row.cells[static_cast<std::size_t>(i)];
    if (cell.model) cell.figures = trial.measure(cell.model);
  });
  for (std::size_t k = 0; k < row.cells.size(); ++k) {
    row.cells[k].breaks = row.cells[k].figures.breaks(row.of.unknown.empty());
    row.cells[k].missed = missed_by(row.cells[k], row.of, methods[k].name);
  }
  return row;
}

// "error, step"
std::string breaks_text(unsigned breaks) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::size(kHardBreaks); ++i)
    if ((breaks & 1U << i) != 0) names.emplace_back(kHardBreaks[i]);
  return joined(names);
}

// One row for each cell, with every figure.
Table cells_table(const std::vector<HardRow>& rows) {
  Table table{"cells", true};
  const std::vector<HardMethod> methods = hard_methods();
  for (const HardRow& row : rows) {
    for (std::size_t k = 0; k < row.cells.size(); ++k) {
      const HardCell& cell = row.cells[k];
      table.begin_row();
      table.add({"case", "case"}, row.of.name);
      table.add({"kind", ""}, kHardKinds[static_cast<std::size_t>(row.of.kind)]);
      table.add({"method", "method"}, methods[k].name);
      table.add({"status", "status"}, cell.refusal.empty() ? "fitted" : "refused");
      table.add({"reason", "reason"}, cell.refusal);
      table.add({"broken", "broken"}, cell.breaks != 0);
      table.add({"breaks", "breaks"}, breaks_text(cell.breaks));
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

// What breaks, or the rank and condition number of the fit.
std::string below_text(const HardCell& cell) {
  const std::string numerics =
      cell.rank == 0 ? "–" : std::to_string(cell.rank) + " · " + general(cell.condition_number, 1);
  if (cell.breaks == 0) return numerics;
  const bool step = (cell.breaks & kBreaksStep) != 0, energy = (cell.breaks & kBreaksEnergy) != 0;
  return breaks_text(cell.breaks) + (step ? " " + general(cell.figures.worst_step_N, 2) + " N" : "") +
         (energy ? " " + general(1e3 * cell.figures.energy_J, 2) + " mJ" : "") + " · " + numerics;
}

// The cases of one kind: a row for each, a column for each method.
Table marks_table(const std::vector<HardRow>& rows, std::size_t kind) {
  Table table{kHardKinds[kind]};
  const std::vector<HardMethod> methods = hard_methods();
  for (const HardRow& row : rows) {
    if (static_cast<std::size_t>(row.of.kind) != kind) continue;
    table.begin_row();
    table.add({"case", "case", 1.0, TableColumn::kThreeDigits, 1}, row.of.name);
    table.add({"why", ""}, row.of.why + (row.of.unknown.empty() ? "" : "; not known: " + row.of.unknown) +
                               (row.of.refusal.empty() ? "" : "; must be refused"));
    for (std::size_t k = 0; k < methods.size(); ++k) {
      table.add({methods[k].name, methods[k].name, 1.0, TableColumn::kThreeDigits, 1}, cell_text(row.cells[k]));
      table.add({methods[k].name + " below", ""}, below_text(row.cells[k]));
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
  const std::vector<HardMethod> methods = hard_methods();
  for (const HardRow& row : rows) {
    for (std::size_t k = 0; k < methods.size(); ++k)
      if (!row.cells[k].missed.empty())
        missed.push_back(row.of.name + ", " + methods[k].name + ": " + row.cells[k].missed);
  }
  return missed;
}

std::string hard_answer(const std::vector<HardRow>& rows) {
  const std::vector<HardMethod> methods = hard_methods();
  std::vector<std::string> stable, energy;
  std::size_t broken = 0;
  for (std::size_t k = 0; k < methods.size(); ++k) {
    std::size_t steady = 0, giving = 0;
    for (const HardRow& row : rows) {
      const unsigned breaks = row.cells[k].breaks;
      steady += (breaks & (kBreaksStep | kBreaksEnergy)) == 0 ? 1 : 0;
      giving += (breaks & kBreaksEnergy) != 0 ? 1 : 0;
      broken += breaks != 0 ? 1 : 0;
    }
    stable.push_back(methods[k].name + (k == 0 ? " is stable on " : " on ") + std::to_string(steady) +
                     (k == 0 ? " of " + std::to_string(rows.size()) : ""));
    if (giving > 0) energy.push_back(methods[k].name + " on " + std::to_string(giving));
  }
  const std::size_t missed = missed_cells(rows).size();
  return joined(stable) + "; " + (energy.empty() ? "none gives energy" : "energy: " + joined(energy)) + ". " +
         std::to_string(broken) + " of " + std::to_string(rows.size() * methods.size()) + " cells are broken, " +
         (missed == 0 ? "each of them known" : std::to_string(missed) + " not as expected") + ".";
}

std::string cell_text(const HardCell& cell) {
  const std::string mark = std::string(cell.breaks == 0 ? "✓" : "✗") + (cell.missed.empty() ? " " : "! ");
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
                       {"jnd", escape_html(kJndDefinition)},
                       {"origin", escape_html(page.origin)}},
                      report, control);
}

}  // namespace palpate
