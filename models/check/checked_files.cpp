// Reads and checks recordings for the commands of the program.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/statistics.h"
#include "engine/base/text.h"
#include "models/check/check_recording.h"
#include "models/samples/samples.h"

namespace palpate {
namespace {

constexpr double kBins = 60.0;         // of the smaller of two ranges of positions
constexpr double kMostBins = 6000.0;   // of the larger one
constexpr double kLeastOverlap = 0.3;  // of the smaller number of bins
constexpr double kTail = 0.05;         // of the forces in a bin, on either side
constexpr double kApartShare = 0.8;
constexpr double kLeastJnds = 2.0;

// The forces of a recording in bins of its positions, from the lowest one on.
struct Bins {
  struct Bin {
    // During loading and unloading; none without rows. A higher speed raises the first and lowers the second, which no
    // shift does.
    std::array<std::optional<double>, 2> median_N;
    double low_N = 0.0, high_N = 0.0;  // the central 90 % of all forces
  };
  double first_m = 0.0;  // the middle of the first bin
  std::vector<Bin> bins{};
};

double range_m(const std::vector<RecordingRow>& rows) {
  const auto [low, high] = std::ranges::minmax(rows, {}, &RecordingRow::position_m);
  return high.position_m - low.position_m;
}

// A reversal by less than the width of a bin counts as noise.
Bins binned(const std::vector<RecordingRow>& rows, double bin_m) {
  const double low_m = std::ranges::min(rows, {}, &RecordingRow::position_m).position_m;
  std::vector<std::array<std::vector<double>, 2>> forces_N(static_cast<std::size_t>(range_m(rows) / bin_m) + 1);
  double turn_m = low_m;
  bool inward = true;
  for (const RecordingRow& row : rows) {
    turn_m = inward ? std::max(turn_m, row.position_m) : std::min(turn_m, row.position_m);
    if (std::abs(row.position_m - turn_m) > bin_m) {
      inward = !inward;
      turn_m = row.position_m;
    }
    forces_N[static_cast<std::size_t>((row.position_m - low_m) / bin_m)][inward ? 0 : 1].push_back(row.force_N);
  }
  Bins made{low_m + 0.5 * bin_m};
  for (const auto& [loading_N, unloading_N] : forces_N) {
    Bins::Bin& bin = made.bins.emplace_back();
    if (!loading_N.empty()) bin.median_N[0] = median_of(loading_N);
    if (!unloading_N.empty()) bin.median_N[1] = median_of(unloading_N);
    std::vector<double> all_N = loading_N;
    all_N.insert(all_N.end(), unloading_N.begin(), unloading_N.end());
    if (all_N.empty()) continue;
    std::ranges::sort(all_N);
    const double last = static_cast<double>(all_N.size() - 1);
    bin.low_N = all_N[static_cast<std::size_t>(kTail * last)];
    bin.high_N = all_N[static_cast<std::size_t>((1.0 - kTail) * last)];
  }
  return made;
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
                   "its forces differ by " + three_digits(std::abs(*found_N)) + " N from those of " + files[j].path +
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
  const auto [smaller_m, larger_m] = std::minmax({range_m(first.recording.rows), range_m(second.recording.rows)});
  const double bin_m = std::max(smaller_m / kBins, larger_m / kMostBins);
  if (!(bin_m > 0.0)) return std::nullopt;
  const Bins a = binned(first.recording.rows, bin_m), b = binned(second.recording.rows, bin_m);
  const bool clear = first.surface.identified() && second.surface.identified();
  const double shift_m = clear ? second.surface.raw_offset_m - first.surface.raw_offset_m : 0.0;
  std::vector<double> differences_N, jnds;
  double compared = 0.0, apart = 0.0;
  for (std::size_t i = 0; i < b.bins.size(); ++i) {
    const Bins::Bin& bin = b.bins[i];
    // Where the middle of this bin is between two of the first recording, whose forces are interpolated.
    const double at = (b.first_m + static_cast<double>(i) * bin_m - shift_m - a.first_m) / bin_m;
    if (!(at >= 0.0) || at + 1.0 >= static_cast<double>(a.bins.size())) continue;
    const auto below = static_cast<std::size_t>(at);
    const std::size_t before = differences_N.size();
    for (const std::size_t direction : {0u, 1u}) {
      const auto& low_N = a.bins[below].median_N[direction];
      const auto& high_N = a.bins[below + 1].median_N[direction];
      if (!low_N || !high_N || !bin.median_N[direction]) continue;
      const double a_N = *low_N + (at - static_cast<double>(below)) * (*high_N - *low_N);
      const double b_N = *bin.median_N[direction];
      differences_N.push_back(b_N - a_N);
      // In air all forces are equal.
      if (std::max(std::abs(a_N), std::abs(b_N)) > jnd.at(0.0))
        jnds.push_back(std::abs(b_N - a_N) / jnd.at(0.5 * (a_N + b_N)));
    }
    if (differences_N.size() == before) continue;
    compared += 1.0;
    const Bins::Bin& nearest = a.bins[static_cast<std::size_t>(at + 0.5)];
    if (bin.low_N > nearest.high_N || nearest.low_N > bin.high_N) apart += 1.0;
  }
  const double least = kLeastOverlap * static_cast<double>(std::min(a.bins.size(), b.bins.size()));
  if (compared < std::max(1.0, least) || apart < kApartShare * compared) return std::nullopt;
  if (!(median_of(std::move(jnds)) > kLeastJnds)) return std::nullopt;
  return median_of(std::move(differences_N));
}

Result<CheckedFile> check_recording_file(const std::string& path, const CheckRequest& request) {
  RecordingFaults faults;
  const auto prepared = read_prepared_recording(path, faults);
  if (!prepared) return prepared.error();
  CheckedFile file{path, *prepared, check_recording(**prepared, request, faults)};
  // Advice names this file, and a new one beside it, so that its commands can be copied.
  const std::filesystem::path given(path);
  const std::string corrected = (given.parent_path() / (given.stem().string() + "_zeroed.csv")).string();
  for (Finding& finding : file.check.findings) {
    for (const auto& [word, name] :
         {std::pair<std::string_view, const std::string&>{" FILE ", path}, {" REC.csv", corrected}}) {
      const std::size_t at = finding.advice.find(word);
      if (at == std::string::npos) continue;
      finding.advice.replace(at, word.size(), " " + shell_word(name) + (word.back() == ' ' ? " " : ""));
    }
  }
  return file;
}

Result<std::vector<CheckedFile>> check_recording_files(const std::vector<std::string>& paths,
                                                       const CheckRequest& request) {
  std::vector<Result<CheckedFile>> checked(paths.size(), CheckedFile{});
  parallel_for(static_cast<int>(paths.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    checked[at] = check_recording_file(paths[at], request);
  });
  std::vector<CheckedFile> files;
  for (Result<CheckedFile>& file : checked) {
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

Result<Recording> read_recording_before(const std::string& path, std::span<const CheckedFile> tests) {
  auto before = read_usable_recording(path);
  for (const CheckedFile& test : tests)
    if (before && test.prepared->content_hash == content_hash(*before))
      return Error{"--after: found the rows of " + test.path + " itself, expected the recording that it continues"};
  return before;
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
