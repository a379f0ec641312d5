// palpate report: every method on the user's recordings, as a page.
#include "scenes/report/report.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/whole_file.h"
#include "scenes/cli/check_recordings.h"
#include "scenes/cli/progress.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

// As it was given, word by word; empty where the system does not say.
std::string command_line() {
  std::string text = read_whole_file("/proc/self/cmdline").value_or("");
  std::replace(text.begin(), text.end(), '\0', ' ');
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

Status run(ReportRequest request) {
  request.command_line = command_line();
  request.version = "palpate " PALPATE_VERSION;
  const auto scene = load_scene(request.scene);
  if (!scene) return scene.error();
  if (request.train.empty() && !request.test.empty()) {
    return Error{"found --test without --train, expected recordings to train on as well; give them with --train"};
  }
  std::vector<std::string> recordings = request.train;
  recordings.insert(recordings.end(), request.test.begin(), request.test.end());
  if (const auto checked = check_before_use(recordings, check_request(*scene)); !checked) return checked.error();
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
  CLI::App* verb = app.add_subcommand("report", "Fit every method, measure speed and error, write a page");
  const auto request = std::make_shared<ReportRequest>();
  verb->add_option("--train", request->train, "Recordings to train on; none: the virtual silicone")->type_name("CSV");
  verb->add_option("--test", request->test, "Recordings to test on; none: k-fold over the training recordings")
      ->type_name("CSV");
  verb->add_option("--scene", request->scene, "Scene whose features and JND line count")->capture_default_str();
  verb->add_option("--out", request->out, "Folder to make")->required()->type_name("DIR");
  verb->add_flag("--quick", request->quick, "Fewer models: some 10 seconds instead of a minute");
  verb->add_flag("--force", request->force, "Replace an earlier report");
  verbs.emplace_back(verb, [request] { return run(*request); });
}

}  // namespace palpate::cli
