// The verbs that write a page of results. palpate report: compares all methods on the user's recordings. palpate paper:
// runs the protocol of Hoever & Harders (2009) on virtual material. palpate hard: every method on every hard case.
#include <cstdio>

#include "engine/base/files.h"
#include "engine/base/text.h"
#include "engine/tick/tool_sample.h"
#include "scenes/cli/verbs.h"
#include "scenes/hard/hard.h"
#include "scenes/report/paper.h"
#include "scenes/report/publish.h"
#include "scenes/report/report.h"

namespace palpate::cli {
namespace {

struct Arguments {
  std::vector<std::string> train, test;
  std::string after;
  std::string scene = "silicone_block";
  double budget_percent = 5.0;  // of the period of a tick
  ReportRequest request;
};

// Prints the file that a verb has just written, for --json. Errors: those of read_plain_file.
Status print_file(const std::string& path) {
  const Result<std::string> text = read_plain_file(path, "the results");
  if (!text) return text.error();
  std::fputs(text->c_str(), stdout);
  return {};
}

Status run_report(Arguments arguments) {
  if (arguments.train.empty() && !arguments.test.empty())
    throw CLI::ValidationError("--test", "found no --train, expected recordings to train on as well; give them");
  const auto scene = load_scene(arguments.scene);
  if (!scene) return scene.error();
  std::vector<std::string> paths = arguments.train;
  paths.insert(paths.end(), arguments.test.begin(), arguments.test.end());
  if (!arguments.after.empty() && arguments.test.empty())
    throw CLI::ValidationError("--after", "found no --test, expected recordings that continue another one; give them");
  ReportRequest& request = arguments.request;
  auto checked = check_before_use(paths, check_request(*scene));
  if (!checked) return checked.error();
  if (!arguments.after.empty()) {
    auto after = read_recording_before(arguments.after, std::span(*checked).subspan(arguments.train.size()));
    if (!after) return after.error();
    request.after = prepare_recording(std::move(*after));
  }
  request.scene = *scene;
  request.test_files = arguments.test;
  request.budget_ns = 1e9 * kHapticTick_s * 0.01 * arguments.budget_percent;
  for (std::size_t i = 0; i < checked->size(); ++i)
    (i < arguments.train.size() ? request.train : request.test).push_back((*checked)[i].prepared);
  const auto answer =
      with_progress("reporting", [&](const FitControl& control) { return make_report(request, control); });
  if (!answer) return answer.error();
  if (request.json) return print_file(request.out + "/report.json");
  print_table(answer->table, true);
  std::printf("\n%s\n", answer->sentence.c_str());
  for (const std::string& line : answer->details) std::printf("  %s\n", line.c_str());
  std::printf("\nspeed against error  %s/figures/speed_error.png, .svg\nreport               %s/index.html\n",
              request.out.c_str(), request.out.c_str());
  return {};
}

// A report for each recording of a folder, and one table of recordings and models.
Status report_each(const Arguments& arguments) {
  const auto job = [&](const std::string& recording, const std::string& result) {
    Arguments one = arguments;
    one.train = {recording};
    one.request.out = result;
    one.request.force = true;
    return run_report(one);
  };
  const auto row = [](const std::string& result) -> FolderRun::Row {
    const auto text = read_plain_file(result + "/report.json", "the results");
    const auto report = nlohmann::ordered_json::parse(text ? *text : "", nullptr, false);
    if (report.is_discarded()) return {};
    FolderRun::Row cells = {{"recommended", report["timings"]["recommended"]}};
    for (const auto& model : report["tables"]["models"])
      cells.emplace_back(model["model"].get<std::string>(), model["within_jnd"]);
    return cells;
  };
  return run_folder(
      {"reporting", arguments.train.front(), arguments.request.out, "", "reports", arguments.request.force, job, row});
}

// With one folder and no test each recording gets its own report; else the recordings of a folder are one set.
Status run_report_or_each(Arguments arguments) {
  if (arguments.train.size() == 1 && arguments.test.empty() && is_folder(arguments.train.front()))
    return report_each(arguments);
  for (std::vector<std::string>* paths : {&arguments.train, &arguments.test}) {
    auto all = recordings_in(*paths);
    if (!all) return all.error();
    *paths = std::move(*all);
  }
  return run_report(std::move(arguments));
}

Status run_paper(const PaperRequest& request) {
  const auto answer =
      with_progress("measuring", [&](const FitControl& control) { return make_paper(request, control); });
  if (!answer) return answer.error();
  if (request.json) return print_file(request.out + "/report.json");
  std::printf("%s\nwritten  %s/index.html, with its tables and figures\n", answer->c_str(), request.out.c_str());
  return {};
}

void print_marks(const std::vector<HardRow>& rows) {
  print_table(table_text(marks_table(rows)), true);
  std::printf(
      "\n%s\n✗: an error, a step or the energy breaks what must hold; !: that was not so before; the number is the "
      "percentage of the ticks in contact within one JND of the true force\n",
      hard_answer(rows).c_str());
}

Status run_hard_cases(const PageRequest& page) {
  if (!page.out.empty()) {  // tried before the cases run, which takes half a minute
    if (const auto trial = ReportFolder::create(page.out, page.force); !trial) return trial.error();
  }
  const auto rows = with_progress("testing", [](const FitControl& control) { return run_hard(control); });
  if (!rows) return rows.error();
  if (page.json) {
    print_json(hard_json(*rows));
  } else {
    print_marks(*rows);
  }
  if (!page.out.empty()) {
    if (const Status written = write_hard_page(*rows, page); !written) return written;
    if (!page.json)
      std::printf("written  %s/index.html, with its tables\n", printable(page.out, std::string::npos).c_str());
  }
  const std::vector<std::string> missed = missed_cells(*rows);
  if (missed.empty()) return {};
  std::string message = std::to_string(missed.size()) + " cells are not as expected";
  for (const std::string& line : missed) message += "\n  " + line;
  return Error{message};
}

CLI::Option* add_page_options(CLI::App* verb, PageRequest& request) {
  request.version = "palpate " PALPATE_VERSION;
  verb->parse_complete_callback([&request] { request.command = kept_command(); });
  verb->add_flag("--json", request.json, "Print one JSON object, which report.json in the folder has, too");
  verb->add_flag("--force", request.force, "Replace an earlier page");
  return verb->add_option("--out", request.out, "Folder to create, with a page of the results")->type_name("DIR");
}

}  // namespace

void add_report(CLI::App& app, Verbs& verbs) {
  CLI::App* verb =
      app.add_subcommand("report", "Fit every method, measure speed and error, and write a page of results");
  const auto arguments = std::make_shared<Arguments>();
  verb->add_option(
          "--train", arguments->train,
          "Training recordings (CSV) or folders of them [virtual silicone]. With one folder and no --test each "
          "recording gets its own report, in parallel; the same command continues a run")
      ->type_name("CSV|FOLDER");
  verb->add_option(
          "--test", arguments->test,
          "Test recordings (CSV) [cross-validation over the training recordings; the last 40 % of a single one]")
      ->type_name("CSV");
  verb->add_option("--after", arguments->after,
                   "Recording that the tests continue: the models begin with the memory of its end (CSV)")
      ->type_name("CSV");
  verb->add_option("--scene", arguments->scene, "Scene that gives the features and the JND line")
      ->capture_default_str()
      ->check(scene_name());
  add_page_options(verb, arguments->request)->required();
  verb->add_option("--budget", arguments->budget_percent,
                   "Longest tick of a model that is recommended, in percent of the period of 1 ms")
      ->check(number_from(1e-6, 100.0))
      ->capture_default_str();
  verb->add_flag("--quick", arguments->request.quick, "Fit the paper's methods and the default only, with 100 centres");
  verbs.emplace_back(verb, [arguments] { return run_report_or_each(*arguments); });
}

void add_paper(CLI::App& app, Verbs& verbs) {
  CLI::App* verb = app.add_subcommand("paper", "Repeat the protocol, figures and claims of Hoever & Harders (2009)");
  const auto request = std::make_shared<PaperRequest>();
  add_page_options(verb, *request)->required();
  verb->add_flag("--quick", request->quick, "Use a fifth of the recordings and fewer fits");
  verbs.emplace_back(verb, [request] { return run_paper(*request); });
}

void add_hard(CLI::App& app, Verbs& verbs) {
  CLI::App* verb = app.add_subcommand("hard", "Run every method on every hard case, and compare with what is expected");
  const auto page = std::make_shared<PageRequest>();
  add_page_options(verb, *page);
  verbs.emplace_back(verb, [page] { return run_hard_cases(*page); });
}

}  // namespace palpate::cli
