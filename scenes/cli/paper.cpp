// palpate paper: runs the protocol of Hoever & Harders (2009) on virtual material.
#include "scenes/report/paper.h"

#include <cstdio>
#include <memory>

#include "scenes/cli/progress.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

Status run(PaperRequest request) {
  request.origin =
      "palpate paper --out " + request.out + (request.quick ? " --quick" : "") + " · palpate " PALPATE_VERSION;
  const Result<std::string> answer = [&] {
    ProgressLine line("measuring");
    FitControl control;
    control.progress = [&](double fraction) { return line.update(fraction); };
    return make_paper(request, control);
  }();
  if (!answer) return answer.error();
  std::printf("%s\nwritten  %s/index.html, with its tables and figures\n", answer->c_str(), request.out.c_str());
  return {};
}

}  // namespace

void add_paper(CLI::App& app, Verbs& verbs) {
  CLI::App* verb = app.add_subcommand("paper", "Repeat the protocol, figures and claims of Hoever & Harders (2009)");
  const auto request = std::make_shared<PaperRequest>();
  verb->add_option("--out", request->out, "Folder to create")->required()->type_name("DIR");
  verb->add_flag("--quick", request->quick, "Use a fifth of the recordings and fewer fits");
  verb->add_flag("--force", request->force, "Replace an earlier result");
  verbs.emplace_back(verb, [request] { return run(*request); });
}

}  // namespace palpate::cli
