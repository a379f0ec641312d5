// palpate check: checks whether a recording is suitable for a fit.
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "engine/base/text.h"
#include "models/check/check_recording.h"
#include "scenes/cli/check_recordings.h"
#include "scenes/cli/output.h"
#include "scenes/cli/verbs.h"
#include "scenes/scene/scene.h"

namespace palpate::cli {
namespace {

struct CheckOptions {
  std::vector<std::string> recordings;
  std::string scene = "silicone_block";
  bool json = false;
};

void print_check_json(const std::vector<CheckedFile>& files) {
  using Json = nlohmann::ordered_json;
  Json list = Json::array();
  for (const CheckedFile& file : files) {
    Json findings = Json::array();
    for (const Finding& finding : file.check.findings) {
      findings.push_back({{"code", finding.code},
                          {"severity", severity_name(finding.severity)},
                          {"value", finding.value},
                          {"text", finding.text},
                          {"advice", finding.advice}});
    }
    list.push_back({{"file", file.path},
                    {"verdict", file.check.verdict()},
                    {"findings", findings},
                    {"noise_floor_within_jnd", file.check.noise_floor_within_jnd},
                    {"surface_identified", file.check.surface_identified},
                    {"surface_offset_m", file.check.surface_offset_m},
                    {"force_zero_N", file.check.force_zero_N}});
  }
  print_json({{"recordings", list}});
}

std::string verdict_text(const RecordingCheck& check) {
  const std::string verdict = check.verdict();
  return verdict == "care" ? "usable with care" : verdict == "unusable" ? "not usable" : "usable";
}

Status run_check(const CheckOptions& options) {
  const auto scene = load_scene(options.scene);
  if (!scene) return scene.error();
  const auto files = check_recording_files(options.recordings, check_request(*scene));
  if (!files) return files.error();
  if (options.json) {
    print_check_json(*files);
  } else {
    for (const CheckedFile& file : *files) std::cout << check_text(file);
  }
  return refuse_unusable(*files);
}

}  // namespace

std::string check_text(const CheckedFile& file) {
  std::ostringstream text;
  text << file.path << ": " << verdict_text(file.check) << "\n";
  for (const Finding& finding : file.check.findings) {
    const std::string severity = severity_name(finding.severity);
    text << "  " << severity << std::string(9 - severity.size(), ' ') << finding.code
         << std::string(finding.code.size() < 17 ? 17 - finding.code.size() : 1, ' ') << finding.text
         << (finding.advice.empty() ? "" : "; " + finding.advice) << "\n";
  }
  text << "  the noise of the force sensor alone leaves " << fixed(100.0 * file.check.noise_floor_within_jnd, 1)
       << " % of the contact samples within the JND; this says nothing about a model\n";
  if (!file.whole) text << "  only the first " << kMostCheckedRows << " rows were checked\n";
  return text.str();
}

CheckRequest check_request(const Scene& scene) { return check_request(scene.jnd, scene.features); }

Result<std::vector<CheckedFile>> check_before_use(const std::vector<std::string>& paths, const CheckRequest& request) {
  auto files = check_recording_files(paths, request);
  if (!files) return files.error();
  if (const Status usable = refuse_unusable(*files); !usable) return usable.error();
  for (const std::string& line : warning_lines(*files)) std::cerr << "warning: " << line << "\n";
  return files;
}

void add_check(CLI::App& app, Verbs& verbs) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* verb = app.add_subcommand("check", "Check whether recordings are suitable for a fit");
  verb->add_option("recording", options->recordings, "Recordings to check (CSV)")->required()->type_name("REC.csv");
  verb->add_option("--scene", options->scene, "Scene that gives the relaxation times and the JND line")
      ->capture_default_str();
  verb->add_flag("--json", options->json, "Print one JSON object");
  verbs.emplace_back(verb, [options] { return run_check(*options); });
}

}  // namespace palpate::cli
