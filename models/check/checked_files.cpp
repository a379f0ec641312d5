// Reads and checks recordings for the commands of the program.
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/text.h"
#include "models/check/check_recording.h"
#include "models/check/force_curve.h"

namespace palpate {
namespace {

constexpr double kApartShare = 0.8;
constexpr double kLeastJnds = 2.0;

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
      const auto found_N = find_contradiction_N(*files[j].prepared, *files[i].prepared, jnd);
      if (!found_N) continue;
      add_finding(files[i],
                  {"contradiction", Severity::warning, *found_N,
                   "its forces differ by " + general(std::abs(*found_N), 2) + " N from those of " + files[j].path +
                       " at the same depth: the cause may be another specimen, a preload, a moved surface, a force "
                       "zero or another speed",
                   "one model cannot render both: fit them separately, or correct the difference first"});
      return;
    }
  }
}

}  // namespace

std::optional<double> find_contradiction_N(const PreparedRecording& first, const PreparedRecording& second,
                                           const JndLine& jnd) {
  const std::vector<RecordingRow>&a = first.recording.rows, &b = second.recording.rows;
  const double bin_m = common_bin_m(a, b);
  if (!(bin_m > 0.0)) return std::nullopt;
  const ForceCurve one(a, bin_m);
  const ForceCurve other(b, bin_m);
  const bool clear = first.surface.identified() && second.surface.identified();
  const double shift_m = clear ? second.surface.raw_offset_m - first.surface.raw_offset_m : 0.0;
  const auto found = difference(one, other, shift_m, jnd);
  if (!found || found->apart_share < kApartShare || !(found->median_jnds > kLeastJnds)) return std::nullopt;
  return found->median_N;
}

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
    std::vector<std::string> fatal;
    for (const Finding& finding : file.check.findings)
      if (finding.severity == Severity::fatal) fatal.push_back(finding_text(finding));
    if (!fatal.empty()) return Error{file.path + ": " + joined(fatal, "; ")};
  }
  return {};
}

std::vector<std::string> warning_lines(const std::vector<CheckedFile>& files) {
  std::vector<std::string> lines;
  for (const CheckedFile& file : files) {
    for (const Finding& finding : file.check.findings)
      if (finding.severity == Severity::warning) lines.push_back(file.path + ": " + finding_text(finding));
  }
  return lines;
}

}  // namespace palpate
