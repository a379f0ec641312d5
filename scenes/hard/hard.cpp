#include "scenes/hard/hard.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/json/json_fields.h"
#include "engine/live/pacer.h"
#include "models/correction/methods.h"
#include "scenes/evaluation/model_errors.h"
#include "scenes/scene/scene.h"

namespace palpate {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr const char* kControlName = "direct-untruncated";
// Of the negative control, whose solve takes the third power of this time.
constexpr int kMostControlSites = 1000;
// Below every singular value of a matrix of doubles: nothing is truncated.
constexpr double kNoTruncation = 1e-300;

// "error, step"
std::string breaks_text(unsigned breaks) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::size(kHardBreaks); ++i)
    if ((breaks & 1U << i) != 0) names.emplace_back(kHardBreaks[i]);
  return joined(names);
}

unsigned breaks_named(const std::string& names) {
  unsigned breaks = 0;
  for (std::size_t i = 0; i < std::size(kHardBreaks); ++i)
    if (names.find(kHardBreaks[i]) != std::string::npos) breaks |= 1U << i;
  return breaks;
}

// All cases. Errors: the file cannot be read, is no JSON or lacks a case.
Result<std::vector<HardCase>> hard_cases() {
  const auto assets = find_assets();
  if (!assets) return assets.error();
  const std::string path = *assets + "/hard/cases.json";
  const auto text = read_plain_file(path, "what breaks in the hard cases");
  if (!text) return text.error();
  const auto document = parse_json(*text, path, 4, {});
  if (!document) return document.error();
  std::vector<HardCase> cases = site_cases();
  std::ranges::move(recording_cases(), std::back_inserter(cases));
  std::ranges::move(material_cases(), std::back_inserter(cases));
  const auto methods = document->value("recorded", std::vector<std::string>{});
  for (HardCase& one : cases) {
    const auto found = document->find(one.name);
    if (found == document->end()) return Error{path + ": found no case \"" + one.name + "\", expected one"};
    one.why = found->value("why", "");
    one.unknown = found->value("unknown", "");
    one.refusal = found->value("refused", "");
    const auto broken = found->value("broken", std::map<std::string, std::string>{});
    for (const std::string& method : methods)
      one.breaks[method] = broken.count(method) > 0 ? breaks_named(broken.at(method)) : 0U;
  }
  return cases;
}

// The numbers of a cell. JSON has null for those that do not apply.
double known(double value, bool applies) { return applies ? value : kNoNumber; }

// A fit is a fifth of a second; a trial of all its models takes as long as one of them.
Result<HardRow> run_case(HardCase one, const FitControl& control) {
  const HardTrial trial = one.build();
  HardRow row{std::move(one), {}};
  const std::vector<HardMethod> methods = hard_methods();
  for (const HardMethod& method : methods) {
    const auto& fitted = trial.training->fit(method, control);
    row.cells.push_back(fitted ? HardCell{*fitted} : HardCell{.refusal = fitted.error().message});
    if (row.cells.back().refusal == interrupted().message) return interrupted();
  }
  parallel_for(static_cast<int>(row.cells.size()), [&](int i) {
    HardCell& cell = row.cells[static_cast<std::size_t>(i)];
    if (cell.fit.model) cell.figures = trial.measure(cell.fit.model);
  });
  for (std::size_t k = 0; k < row.cells.size(); ++k) {
    row.cells[k].breaks = row.cells[k].figures.breaks(row.of.unknown.empty());
    row.cells[k].missed = missed_by(row.cells[k], row.of, methods[k].name);
  }
  return row;
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
      table.add({"kind", ""}, row.of.kind);
      table.add({"method", "method"}, methods[k].name);
      table.add({"status", "status"}, cell.refusal.empty() ? "fitted" : "refused");
      table.add({"reason", "reason"}, cell.refusal);
      table.add({"broken", "broken"}, cell.breaks != 0);
      table.add({"breaks", "breaks"}, breaks_text(cell.breaks));
      table.add({"expected", "as expected"}, cell.missed.empty());
      table.add({"missed", "missed"}, cell.missed);
      table.add({"rank", "rank"}, known(static_cast<double>(cell.fit.rank), cell.fit.rank > 0));
      table.add({"condition_number", "condition"}, known(cell.fit.condition_number, cell.fit.condition_number > 0.0));
      table.add({"within_jnd", "≤ JND [%]", kInPercent, 2}, cell.figures.within_jnd);
      table.add({"worst_error_N", "worst [N]"}, cell.figures.worst_error_N);
      table.add({"worst_step_N", "step [mN]", kInMilli}, cell.figures.worst_step_N);
      table.add({"energy_J", "energy [mJ]", kInMilli}, cell.figures.energy_J);
      table.add({"seconds", "fit [s]"}, known(cell.fit.seconds, cell.fit.model != nullptr));
    }
  }
  return table;
}

std::string cell_text(const HardCell& cell) {
  const std::string mark = std::string(cell.breaks == 0 ? "✓" : "✗") + (cell.missed.empty() ? " " : "! ");
  if (!cell.refusal.empty()) return mark + "refused";
  return mark +
         (std::isnan(cell.figures.within_jnd) ? "–" : fixed(0.1 * std::floor(1000.0 * cell.figures.within_jnd), 1));
}

// What breaks, or the rank and condition number of the fit.
std::string below_text(const HardCell& cell) {
  const std::string numerics =
      cell.fit.rank == 0 ? "–" : std::to_string(cell.fit.rank) + " · " + general(cell.fit.condition_number, 1);
  if (cell.breaks == 0) return numerics;
  const bool step = (cell.breaks & kBreaksStep) != 0, energy = (cell.breaks & kBreaksEnergy) != 0;
  return breaks_text(cell.breaks) + (step ? " " + general(cell.figures.worst_step_N, 2) + " N" : "") +
         (energy ? " " + general(1e3 * cell.figures.energy_J, 2) + " mJ" : "") + " · " + numerics;
}

}  // namespace

unsigned HardFigures::breaks(bool error_counts) const {
  return (error_counts && within_jnd < kWithin ? kBreaksError : 0U) | (step_over_N > 0.0 ? kBreaksStep : 0U) |
         (energy_J > kHardEncoder_m * largest_N ? kBreaksEnergy : 0U);
}

std::vector<HardMethod> hard_methods() {
  std::vector<HardMethod> list;
  for (const ModelPlan& plan : all_plans()) {
    if (plan.base == Base::force || plan.method == &kTrendMethod || plan.method == ModelPlan{}.method)
      list.push_back({plan_name(plan), plan});
  }
  list.push_back({kControlName, {.base = Base::force, .method = &kRandomMethod, .centres = kMostControlSites}, true});
  return list;
}

Result<MethodFit> HardTraining::untruncated(const ModelPlan& plan, const FitControl& control) {
  const auto prepared = fits_.prepare(plan, control);
  if (!prepared) return prepared.error();
  // With every distinct site as a centre the least squares problem of eq. 8 is the interpolation of eq. 4.
  const OpenChoices choices{.truncation = kNoTruncation};
  return fit_method(**prepared, plan, control, nullptr, &choices);
}

const Result<MethodFit>& HardTraining::fit(const HardMethod& method, const FitControl& control) {
  if (const auto made = made_.find(method.name); made != made_.end()) return made->second;
  ModelPlan asked = common_;
  asked.base = method.plan.base;
  asked.method = method.plan.method;
  asked.centres = method.plan.centres;
  const double start_s = steady_now_s();
  auto fit = method.untruncated ? untruncated(asked, control) : fits_.fit(asked, control);
  if (fit) fit->seconds = steady_now_s() - start_s;
  return made_.emplace(method.name, std::move(fit)).first->second;
}

std::string missed_by(const HardCell& cell, const HardCase& of, const std::string& method) {
  if (!of.refusal.empty()) {
    if (cell.refusal.empty()) return "fitted, expected a refusal";
    return cell.refusal.find(of.refusal) != std::string::npos
               ? ""
               : "refused with another reason, expected \"" + of.refusal + "\"";
  }
  if (!cell.refusal.empty()) return "refused, expected a fit";
  if (std::isinf(cell.figures.worst_step_N)) return "a force that is not finite";
  const auto recorded = of.breaks.find(method);
  const unsigned unexpected = recorded != of.breaks.end() ? cell.breaks & ~recorded->second : 0U;
  return unexpected != 0 ? "breaks " + breaks_text(unexpected) : "";
}

void HardMeasure::add(double force_N, double true_N, bool counts, double position_m) {
  if (std::isfinite(last_m_)) {
    // The trapezoidal rule. A force that pushes the tool out (towards smaller positions) gives out energy.
    const double way_m = position_m - last_m_;
    given_J_ -= 0.5 * (force_N + last_N_) * way_m;
    truly_given_J_ -= 0.5 * (true_N + last_true_N_) * way_m;
    figures_.energy_J = std::fmax(figures_.energy_J, given_J_ - std::max(0.0, truly_given_J_));
  } else if (std::isfinite(position_m)) {
    figures_.energy_J = 0.0;
  }
  const double jnd_N = JndLine{}.at(true_N);
  // A force that is not finite is never within the JND, and an infinite error.
  const double error_N = std::isfinite(force_N) ? std::abs(force_N - true_N) : kEndless;
  if (counts) {
    within_ += error_N <= jnd_N ? 1 : 0;
    figures_.within_jnd = static_cast<double>(within_) / static_cast<double>(++counted_);
    figures_.worst_error_N = std::fmax(figures_.worst_error_N, error_N);
  }
  if (ticks_ > 0) {
    const double change_N = std::abs(force_N - last_N_), step_N = std::isfinite(change_N) ? change_N : kEndless;
    figures_.worst_step_N = std::fmax(figures_.worst_step_N, step_N);
    beyond_jnd_N_ = std::max(beyond_jnd_N_, step_N - jnd_N);
    true_step_N_ = std::max(true_step_N_, std::abs(true_N - last_true_N_));
    figures_.step_over_N = beyond_jnd_N_ - true_step_N_;
  }
  figures_.largest_N = std::max(figures_.largest_N, std::abs(true_N));
  last_m_ = position_m;
  last_true_N_ = true_N;
  last_N_ = force_N;
  ++ticks_;
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

Table marks_table(const std::vector<HardRow>& rows, const std::string& kind) {
  Table table{kind.empty() ? "cases" : kind};
  const std::vector<HardMethod> methods = hard_methods();
  for (const HardRow& row : rows) {
    if (!kind.empty() && row.of.kind != kind) continue;
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

nlohmann::ordered_json hard_json(const std::vector<HardRow>& rows) {
  return {{"cells", table_json(cells_table(rows))}};
}

Status write_hard_page(const std::vector<HardRow>& rows, const PageRequest& page, const FitControl& control) {
  auto folder = ReportFolder::create(page.out, page.force);
  if (!folder) return folder.error();
  std::vector<Table> tables;
  for (const char* kind : kHardKinds) tables.push_back(marks_table(rows, kind));
  tables.push_back(cells_table(rows));
  const std::vector<std::string> missed = missed_cells(rows);
  nlohmann::ordered_json report{{"format", "palpate-hard"}, {"version", 1}, {"answer", hard_answer(rows)}};
  report.update(hard_json(rows));
  return write_report(
      *folder, page, "hard.html", tables, {},
      {{"title", "Palpate: every method on every hard case"},
       {"answer", escape_html(hard_answer(rows))},
       {"missed", missed.empty() ? "" : "<h2>Not as expected</h2>\n<ul>\n" + list_html(missed) + "</ul>\n"}},
      report, control);
}

}  // namespace palpate
