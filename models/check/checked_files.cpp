// Reads and checks recordings for the commands of the program.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "engine/base/text.h"
#include "models/check/check_recording.h"
#include "models/samples/sample.h"

namespace palpate {
namespace {

// Of two recordings, in bins of their positions.
constexpr double kBins = 60.0;         // in the smaller range
constexpr double kMostBins = 6000.0;   // in the larger one
constexpr double kLeastOverlap = 0.3;  // of the smaller number of bins
constexpr double kApartShare = 0.8;
constexpr double kLeastJnds = 2.0;

double range_m(const std::vector<RecordingRow>& rows) {
  const auto [low, high] = std::ranges::minmax(rows, {}, &RecordingRow::position_m);
  return high.position_m - low.position_m;
}

// The forces in a bin during loading and unloading: a higher speed raises the first and lowers the second, which no
// shift does.
using BinForces = std::array<std::vector<double>, 2>;

// A reversal by less than the width of a bin counts as noise.
std::map<long, BinForces> binned_forces_N(const std::vector<RecordingRow>& rows, double surface_m, double bin_m) {
  std::map<long, BinForces> bins;
  double turn_m = rows.front().position_m;
  bool inward = true;
  for (const RecordingRow& row : rows) {
    turn_m = inward ? std::max(turn_m, row.position_m) : std::min(turn_m, row.position_m);
    if (std::abs(row.position_m - turn_m) > bin_m) {
      inward = !inward;
      turn_m = row.position_m;
    }
    bins[std::lround((row.position_m - surface_m) / bin_m)][inward ? 0 : 1].push_back(row.force_N);
  }
  return bins;
}

// The central 90 % of the forces in a bin.
std::pair<double, double> central_N(const BinForces& forces_N) {
  std::vector<double> all_N = forces_N[0];
  all_N.insert(all_N.end(), forces_N[1].begin(), forces_N[1].end());
  std::ranges::sort(all_N);
  const double last = static_cast<double>(all_N.size() - 1);
  return {all_N[static_cast<std::size_t>(0.05 * last)], all_N[static_cast<std::size_t>(0.95 * last)]};
}

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
  const auto [smaller_m, larger_m] = std::minmax({range_m(a), range_m(b)});
  const double bin_m = std::max(smaller_m / kBins, larger_m / kMostBins);
  if (!(bin_m > 0.0)) return std::nullopt;
  const bool clear = first.surface.identified() && second.surface.identified();
  const auto bins_a = binned_forces_N(a, clear ? first.surface.raw_offset_m : 0.0, bin_m);
  const auto bins_b = binned_forces_N(b, clear ? second.surface.raw_offset_m : 0.0, bin_m);
  std::vector<double> differences_N, jnds;
  double compared = 0.0, apart = 0.0;
  for (const auto& [bin, of_b] : bins_b) {
    const auto of_a = bins_a.find(bin);
    if (of_a == bins_a.end()) continue;
    const std::size_t before = differences_N.size();
    for (const std::size_t direction : {0u, 1u}) {
      if (of_a->second[direction].empty() || of_b[direction].empty()) continue;
      const double a_N = median_of(of_a->second[direction]), b_N = median_of(of_b[direction]);
      differences_N.push_back(b_N - a_N);
      // In air all forces are equal.
      if (std::max(std::abs(a_N), std::abs(b_N)) > jnd.at(0.0))
        jnds.push_back(std::abs(b_N - a_N) / jnd.at(0.5 * (a_N + b_N)));
    }
    if (differences_N.size() == before) continue;
    const auto [low_a_N, high_a_N] = central_N(of_a->second);
    const auto [low_b_N, high_b_N] = central_N(of_b);
    compared += 1.0;
    if (low_b_N > high_a_N || low_a_N > high_b_N) apart += 1.0;
  }
  const bool overlap = compared >= kLeastOverlap * static_cast<double>(std::min(bins_a.size(), bins_b.size()));
  if (!overlap || apart < kApartShare * compared || !(median_of(std::move(jnds)) > kLeastJnds)) return std::nullopt;
  return median_of(std::move(differences_N));
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
