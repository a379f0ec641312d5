// Recordings read and checked, for the verbs.
#include <algorithm>
#include <memory>
#include <utility>

#include "models/check/check_recording.h"

namespace palpate {
namespace {

void add_repetitions(std::vector<CheckedFile>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (files[i].check.content_hash != files[j].check.content_hash) continue;
      files[i].check.findings.insert(
          files[i].check.findings.begin(),
          {"repeated", Severity::warning, 1.0, "it has the same rows as " + files[j].path,
           "name every recording once: a repeated one counts twice, and errors on it say nothing"});
      auto& findings = files[i].check.findings;
      std::stable_sort(findings.begin(), findings.end(),
                       [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
      break;
    }
  }
}

std::string finding_line(const CheckedFile& file, const Finding& finding) {
  return file.path + ": " + finding.code + ": " + finding.text + (finding.advice.empty() ? "" : "; " + finding.advice);
}

}  // namespace

Result<CheckedFile> check_recording_file(const std::string& path, const CheckRequest& request) {
  auto recording = read_recording(path, kMostCheckedRows);
  if (!recording) return recording.error();
  const bool whole = recording->rows.size() < kMostCheckedRows;
  RecordingCheck check = check_recording(*recording, request);
  return CheckedFile{path, std::move(*recording), whole, std::move(check)};
}

Result<std::vector<CheckedFile>> check_recording_files(const std::vector<std::string>& paths,
                                                       const CheckRequest& request) {
  std::vector<CheckedFile> files;
  for (const std::string& path : paths) {
    auto file = check_recording_file(path, request);
    if (!file) return file.error();
    files.push_back(std::move(*file));
  }
  add_repetitions(files);
  return files;
}

std::vector<MotionSource::Input> training_inputs(std::vector<CheckedFile> files) {
  std::vector<MotionSource::Input> inputs;
  for (CheckedFile& file : files) {
    MotionSource::Input input{std::move(file.path), nullptr};
    if (file.whole) input.loaded = std::make_shared<const Recording>(std::move(file.recording));
    if (file.whole && !file.check.motion.empty()) {
      input.motion = std::make_shared<const std::vector<MotionEstimate>>(std::move(file.check.motion));
    }
    inputs.push_back(std::move(input));
  }
  return inputs;
}

Status refuse_unusable(const std::vector<CheckedFile>& files) {
  for (const CheckedFile& file : files) {
    for (const Finding& finding : file.check.findings) {
      if (finding.severity == Severity::fatal) return Error{finding_line(file, finding)};
    }
  }
  return {};
}

std::vector<std::string> warning_lines(const std::vector<CheckedFile>& files) {
  std::vector<std::string> lines;
  for (const CheckedFile& file : files) {
    for (const Finding& finding : file.check.findings) {
      if (finding.severity == Severity::warning) lines.push_back(finding_line(file, finding));
    }
  }
  return lines;
}

}  // namespace palpate
