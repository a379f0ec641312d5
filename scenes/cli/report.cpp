// palpate report: compares all methods on the user's recordings, as a page.
#include "scenes/report/report.h"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "scenes/cli/check_recordings.h"
#include "scenes/cli/progress.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

struct Arguments {
  std::vector<std::string> train;
  std::vector<std::string> test;
  std::string scene = "silicone_block";
  std::string out;
  bool quick = false;
  bool force = false;
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
  if (arguments.quick) text += " --quick";
  add("--out", {arguments.out});
  return text;
}

Status run(const Arguments& arguments) {
  if (arguments.train.empty() && !arguments.test.empty()) {
    return Error{"found --test without --train, expected recordings to train on as well; give them with --train"};
  }
  const auto scene = load_scene(arguments.scene);
  if (!scene) return scene.error();
  std::vector<std::string> paths = arguments.train;
  paths.insert(paths.end(), arguments.test.begin(), arguments.test.end());
  auto checked = check_before_use(paths, check_request(*scene));
  if (!checked) return checked.error();
  ReportRequest request{*scene,
                        {},
                        {},
                        arguments.quick,
                        arguments.out,
                        arguments.force,
                        command_line(arguments),
                        "palpate " PALPATE_VERSION};
  for (std::size_t i = 0; i < checked->size(); ++i) {
    const PreparedRecordingPointer& prepared = (*checked)[i].prepared;
    (i < arguments.train.size() ? request.train : request.test).emplace_back(prepared, &prepared->recording);
  }
  const Result<std::string> answer = [&] {
    ProgressLine line("reporting");
    FitControl control;
    control.progress = [&](double fraction) { return line.update(fraction); };
    return make_report(request, control);
  }();
  if (!answer) return answer.error();
  std::printf("%s\n", answer->c_str());
  std::printf("written  %s/index.html, with its tables and figures\n", request.out.c_str());
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
  verb->add_option("--out", arguments->out, "Folder to create")->required()->type_name("DIR");
  verb->add_flag("--quick", arguments->quick, "Fit fewer models: about 10 s instead of a minute");
  verb->add_flag("--force", arguments->force, "Replace an earlier report");
  verbs.emplace_back(verb, [arguments] { return run(*arguments); });
}

}  // namespace palpate::cli
