// palpate hard: every method on every hard case.
#include <cstdio>
#include <memory>
#include <string>

#include "scenes/cli/progress.h"
#include "scenes/cli/shared.h"
#include "scenes/cli/verbs.h"
#include "scenes/hard/hard_table.h"

namespace palpate::cli {
namespace {

struct HardOptions {
  HardPage page;
  bool json = false;
};

void print_marks(const std::vector<HardRow>& rows) {
  std::vector<std::vector<std::string>> lines{{"case"}};
  for (const ModelPlan& plan : hard_plans()) lines.front().push_back(plan_name(plan));
  for (const HardRow& row : rows) {
    lines.push_back({row.of.name});
    for (const HardCell& cell : row.cells) lines.back().push_back(cell_text(cell));
  }
  print_table(lines, true);
  std::printf(
      "\n✓ as expected, ✗ not; the number is the percentage of the ticks in contact within the JND of the true "
      "force\n%s\n",
      hard_answer(rows).c_str());
}

Status run(const HardOptions& options) {
  const auto rows = with_progress("testing", [](const FitControl& control) { return run_hard(control); });
  if (!rows) return rows.error();
  if (options.json) {
    print_json(hard_json(*rows));
  } else {
    print_marks(*rows);
  }
  if (!options.page.out.empty()) {
    if (const Status written = write_hard_page(*rows, options.page); !written) return written;
    if (!options.json) std::printf("written  %s/index.html, with its tables\n", options.page.out.c_str());
  }
  const std::vector<std::string> missed = missed_cells(*rows);
  if (missed.empty()) return {};
  std::string message = std::to_string(missed.size()) + " cells are not as expected";
  for (const std::string& line : missed) message += "\n  " + line;
  return Error{message};
}

}  // namespace

void add_hard(CLI::App& app, Verbs& verbs) {
  CLI::App* verb = app.add_subcommand("hard", "Run every method on every hard case, and compare with what is expected");
  const auto options = std::make_shared<HardOptions>();
  verb->add_option("--out", options->page.out, "Folder to create, with a page of the results")->type_name("DIR");
  verb->add_flag("--json", options->json, "Print one JSON object");
  verb->add_flag("--force", options->page.force, "Replace an earlier page");
  verbs.emplace_back(verb, [options] {
    options->page.origin = "palpate hard --out " + options->page.out + " · palpate " PALPATE_VERSION;
    return run(*options);
  });
}

}  // namespace palpate::cli
