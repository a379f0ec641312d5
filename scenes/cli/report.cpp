// palpate report: compares all methods on the user's recordings, as a table and a page. palpate paper: runs the
// protocol of Hoever & Harders (2009) on virtual material.
#include "scenes/report/report.h"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "scenes/cli/progress.h"
#include "scenes/cli/shared.h"
#include "scenes/cli/verbs.h"
#include "scenes/report/paper.h"

namespace palpate::cli {
namespace {

struct Arguments {
  std::vector<std::string> train, test;
  std::string scene = "silicone_block";
  bool json = false;
  ReportRequest request;
};

// The command that makes the same report again.
std::string command_line(const Arguments& arguments) {
  std::string text = "palpate report";
  const auto add = [&](const char* option, const std::vector<std::string>& values) {
    if (!values.empty()) text += std::string(" ") + option;
    for (const std::string& value : values) text += " " + value;
  };
  add("--train", arguments.train);
  add("--test", arguments.test);
  add("--scene", {arguments.scene});
  if (arguments.request.quick) text += " --quick";
  add("--out", {arguments.request.out});
  return text;
}

Status run_report(Arguments arguments) {
  if (arguments.train.empty() && !arguments.test.empty())
    return Error{"found --test without --train, expected recordings to train on as well; give them with --train"};
  const auto scene = load_scene(arguments.scene);
  if (!scene) return scene.error();
  std::vector<std::string> paths = arguments.train;
  paths.insert(paths.end(), arguments.test.begin(), arguments.test.end());
  auto checked = check_before_use(paths, check_request(*scene));
  if (!checked) return checked.error();
  ReportRequest& request = arguments.request;
  request.scene = *scene;
  request.command_line = command_line(arguments);
  request.version = "palpate " PALPATE_VERSION;
  for (std::size_t i = 0; i < checked->size(); ++i)
    (i < arguments.train.size() ? request.train : request.test).push_back((*checked)[i].prepared);
  const auto answer =
      with_progress("reporting", [&](const FitControl& control) { return make_report(request, control); });
  if (!answer) return answer.error();
  if (arguments.json) return print_file(request.out + "/report.json");
  print_table(answer->table, true);
  std::printf("\n%s\n\nspeed against error  %s/figures/speed_error.png, .svg\nreport               %s/index.html\n",
              answer->sentence.c_str(), request.out.c_str(), request.out.c_str());
  return {};
}

Status run_paper(PaperRequest request, bool json) {
  request.origin =
      "palpate paper --out " + request.out + (request.quick ? " --quick" : "") + " · palpate " PALPATE_VERSION;
  const auto answer =
      with_progress("measuring", [&](const FitControl& control) { return make_paper(request, control); });
  if (!answer) return answer.error();
  if (json) return print_file(request.out + "/report.json");
  std::printf("%s\nwritten  %s/index.html, with its tables and figures\n", answer->c_str(), request.out.c_str());
  return {};
}

}  // namespace

void add_report(CLI::App& app, Verbs& verbs) {
  CLI::App* verb =
      app.add_subcommand("report", "Fit every method, measure speed and error, and write a page of results");
  const auto arguments = std::make_shared<Arguments>();
  verb->add_option("--train", arguments->train, "Training recordings (CSV) [virtual silicone]")->type_name("CSV");
  verb->add_option("--test", arguments->test,
                   "Test recordings (CSV) [k-fold cross-validation of the training recordings]")
      ->type_name("CSV");
  verb->add_option("--scene", arguments->scene, "Scene that gives the features and the JND line")
      ->capture_default_str();
  verb->add_option("--out", arguments->request.out, "Folder to create")->required()->type_name("DIR");
  verb->add_flag("--quick", arguments->request.quick, "Fit the paper's methods and the default only, with 100 centres");
  verb->add_flag("--json", arguments->json, "Print report.json, which is also in the folder");
  verb->add_flag("--force", arguments->request.force, "Replace an earlier report");
  verbs.emplace_back(verb, [arguments] { return run_report(*arguments); });
}

void add_paper(CLI::App& app, Verbs& verbs) {
  CLI::App* verb = app.add_subcommand("paper", "Repeat the protocol, figures and claims of Hoever & Harders (2009)");
  const auto request = std::make_shared<PaperRequest>();
  verb->add_option("--out", request->out, "Folder to create")->required()->type_name("DIR");
  verb->add_flag("--quick", request->quick, "Use a fifth of the recordings and fewer fits");
  const auto json = std::make_shared<bool>(false);
  verb->add_flag("--json", *json, "Print report.json, which is also in the folder");
  verb->add_flag("--force", request->force, "Replace an earlier result");
  verbs.emplace_back(verb, [request, json] { return run_paper(*request, *json); });
}

}  // namespace palpate::cli
