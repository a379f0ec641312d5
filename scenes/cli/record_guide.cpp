#include "scenes/cli/record_guide.h"

#include <algorithm>
#include <utility>

#include "engine/base/atomic_file.h"
#include "engine/live/pacer.h"

namespace palpate::cli {

constexpr double kPeriod_s = 2.0;
constexpr double kRest = 10.0;  // pause after a check, as a multiple of its duration
constexpr int kSmallStrokes = 10;
constexpr const char* kFollowed[] = {"explored", "no_hold", "short_hold"};

RecordGuide::RecordGuide(const std::string& path, const CheckRequest& request)
    : path_(AtomicFile::part_of(path)), request_(request) {}

std::vector<std::string> RecordGuide::advice() const {
  const auto file = check_recording_file(path_, request_);
  if (!file || file->check.measures.contact_rows == 0) return {"next: touch the block, then press it slowly"};
  std::vector<std::string> lines;
  for (const Finding& finding : file->check.findings) {
    const bool followed = std::ranges::find(kFollowed, finding.code) != std::end(kFollowed);
    if (followed && !finding.advice.empty()) lines.push_back(finding.advice);
  }
  if (file->check.measures.small_strokes < kSmallStrokes)
    lines.emplace_back("make small strokes: stay in the block and move a little in and out");
  if (lines.empty()) lines.emplace_back("nothing is missing: Ctrl-C ends the recording");
  return lines;
}

std::vector<std::string> RecordGuide::update(double now_s) {
  if (now_s < next_s_) return {};
  const double start_s = steady_now_s();
  std::vector<std::string> lines = advice();
  next_s_ = now_s + std::max(kPeriod_s, kRest * (steady_now_s() - start_s));
  return std::exchange(printed_, lines) == lines ? std::vector<std::string>{} : lines;
}

}  // namespace palpate::cli
