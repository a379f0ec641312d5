#include <cmath>

#include "engine/base/text.h"
#include "scenes/hard/hard_table.h"
#include "scenes/report/publish.h"

namespace palpate {
namespace {

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
