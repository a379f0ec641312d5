// palpate check: checks whether a recording is suitable for a fit.
#include <memory>
#include <string>
#include <vector>

#include "engine/base/text.h"
#include "scenes/cli/verbs.h"

namespace palpate::cli {
namespace {

struct CheckOptions {
  std::vector<std::string> recordings;
  std::string scene = "silicone_block";
  bool json = false;
};

Status run_check(const CheckOptions& options) {
  const auto scene = load_scene(options.scene);
  if (!scene) return scene.error();
  const auto files = check_recording_files(options.recordings, check_request(*scene));
  if (!files) return files.error();
  print_check(*files, options.json);
  // The findings are printed already.
  for (const CheckedFile& file : *files) {
    if (refuse_unusable({file})) continue;
    std::vector<std::string> codes;
    for (const Finding& finding : file.check.findings)
      if (finding.severity == Severity::fatal) codes.push_back(finding.code);
    return Error{file.path + ": not usable for a fit: " + joined(codes) + "; follow the advice above"};
  }
  return {};
}

}  // namespace

void add_check(CLI::App& app, Verbs& verbs) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = app.add_subcommand("check", "Check whether recordings are suitable for a fit");
  verb->add_option("recording", options->recordings, "Recordings to check (CSV)")->required()->type_name("REC.csv");
  verb->add_option("--scene", options->scene, "Scene that gives the JND line, and whether the force has a memory")
      ->capture_default_str()
      ->check(scene_name());
  verb->add_flag("--json", options->json, "Print one JSON object");
  verbs.emplace_back(verb, [options] { return run_check(*options); });
}

}  // namespace palpate::cli
