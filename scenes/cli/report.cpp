// palpate report: every method on the user's recordings, as a page.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "scenes/cli/check_recordings.h"
#include "scenes/cli/progress.h"
#include "scenes/cli/verbs.h"
#include "scenes/report/report.h"

namespace palpate::cli {
namespace {

// One word of a command line as a shell would need it.
std::string shell_word(const std::string& word) {
  const char* const plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted("'");
  for (const char letter : word) {
    if (letter == '\'') {
      quoted.append("'\\''");
    } else {
      quoted.push_back(letter);
    }
  }
  return quoted.append("'");
}

std::string command_line(const ReportRequest& request) {
  std::string text("palpate report");
  const auto add_list = [&](const char* option, const std::vector<std::string>& words) {
    if (words.empty()) return;
    text.append(option);
    for (const std::string& word : words) text.append(" ").append(shell_word(word));
  };
  add_list(" --train", request.train);
  add_list(" --test", request.test);
  text.append(" --scene ").append(shell_word(request.scene));
  text.append(" --out ").append(shell_word(request.out));
  if (request.quick) text.append(" --quick");
  return text;
}

Status run(ReportRequest request) {
  request.command_line = command_line(request);
  request.version = "palpate " PALPATE_VERSION;
  const auto scene = load_scene(request.scene);
  if (!scene) return scene.error();
  std::vector<std::string> recordings = request.train;
  recordings.insert(recordings.end(), request.test.begin(), request.test.end());
  if (const auto checked = check_before_use(recordings, check_request(*scene)); !checked) return checked.error();
  Result<ReportSummary> summary = [&] {
    ProgressLine line("reporting");
    FitControl control;
    control.progress = [&](double fraction) { return line.update(fraction); };
    return make_report(request, control);
  }();
  if (!summary) return summary.error();
  for (const std::string& sentence : summary->findings) std::printf("%s\n", sentence.c_str());
  std::printf("written  %s/index.html and %zu more files\n", request.out.c_str(), summary->files.size() - 1);
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
  verb->add_flag("--quick", request->quick, "Fewer sizes: some 20 seconds instead of minutes");
  verb->add_flag("--force", request->force, "Replace an earlier report");
  verbs.emplace_back(verb, [request] { return run(*request); });
}

}  // namespace palpate::cli
