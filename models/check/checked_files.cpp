// Reads and checks recordings for the commands of the program.
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/base/text.h"
#include "models/check/check_recording.h"
#include "models/check/contradiction.h"

namespace palpate {
namespace {

// Above this ratio of speeds a material may have different loading forces.
constexpr double kOtherSpeed = 3.0;

// Inserts a finding before those of its severity.
void add_finding(CheckedFile& file, Finding finding) {
  auto& findings = file.check.findings;
  const auto place =
      std::ranges::find_if(findings, [&](const Finding& one) { return one.severity <= finding.severity; });
  findings.insert(place, std::move(finding));
}

void add_repetitions(std::vector<CheckedFile>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (files[i].prepared->content_hash != files[j].prepared->content_hash) continue;
      add_finding(
          files[i],
          {"repeated", Severity::warning, 1.0, "the file has the same rows as " + files[j].path,
           "name every recording once: a repeated recording counts twice in a fit and proves nothing in a test"});
      break;
    }
  }
}

// Adds a finding to the first file that contradicts an earlier one.
void add_contradiction(std::vector<CheckedFile>& files, const JndLine& jnd) {
  for (std::size_t i = 1; i < files.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto found = find_contradiction(files[j].recording(), files[i].recording(), jnd);
      if (!found) continue;
      const bool speed = found->speed_ratio > kOtherSpeed;
      add_finding(files[i], {"contradiction", Severity::warning, found->force_N,
                             "its forces differ by " + general(std::abs(found->force_N), 2) + " N from those of " +
                                 files[j].path + " at the same depth: the cause may be another specimen, a preload" +
                                 (speed ? ", a force zero or a speed ratio of " + general(found->speed_ratio, 2)
                                        : std::string(" or a force zero")),
                             "one model cannot render both: fit them separately, or correct the difference first"});
      return;
    }
  }
}

}  // namespace

Result<CheckedFile> check_recording_file(const std::string& path, const CheckRequest& request) {
  RecordingFaults faults;
  auto recording = read_usable_recording(path, kMostCheckedRows, &faults);
  if (!recording) return recording.error();
  const bool whole = faults.rows < kMostCheckedRows;
  PreparedRecordingPointer prepared = prepare_recording(std::move(*recording));
  CheckedFile file{path, prepared, whole, check_recording(*prepared, request, faults)};
  if (!whole) {
    add_finding(file, {"truncated", Severity::warning, static_cast<double>(kMostCheckedRows),
                       "only the first " + std::to_string(kMostCheckedRows) + " rows are used",
                       "split the recording to use all of it"});
  }
  return file;
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
  add_contradiction(files, request.jnd);
  return files;
}

std::vector<PreparedRecordingPointer> training_recordings(std::vector<CheckedFile> files) {
  std::vector<PreparedRecordingPointer> recordings;
  for (CheckedFile& file : files) recordings.push_back(std::move(file.prepared));
  return recordings;
}

Status refuse_unusable(const std::vector<CheckedFile>& files) {
  for (const CheckedFile& file : files) {
    for (const Finding& finding : file.check.findings) {
      if (finding.severity == Severity::fatal) return Error{file.path + ": " + finding_text(finding)};
    }
  }
  return {};
}

std::vector<std::string> warning_lines(const std::vector<CheckedFile>& files) {
  std::vector<std::string> lines;
  for (const CheckedFile& file : files) {
    for (const Finding& finding : file.check.findings) {
      if (finding.severity == Severity::warning) lines.push_back(file.path + ": " + finding_text(finding));
    }
  }
  return lines;
}

}  // namespace palpate
