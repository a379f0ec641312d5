#include "rendering/panels/view_state.h"

#include <algorithm>
#include <utility>

namespace palpate {

void RecordingRoles::add(ConvertedRecording recording) {
  std::erase_if(recordings, [&](const ConvertedRecording& other) { return other.path == recording.path; });
  recordings.push_back(std::move(recording));
  if (recordings.size() > 1) tested = recordings.back().path;
}

std::vector<std::string> RecordingRoles::training() const {
  std::vector<std::string> paths;
  for (const ConvertedRecording& one : recordings)
    if (one.path != tested) paths.push_back(one.path);
  return paths;
}

void CurveTime::pause(double at_s) noexcept {
  if (paused) return;
  paused = true;
  paused_at_s = at_s;
  scrolled_back_s = 0.0;
}

void CurveTime::zoom(double one_s, double other_s) noexcept {
  paused = true;
  scrolled_back_s = 0.0;
  paused_at_s = std::max(one_s, other_s);
  shown_s = std::max(kLeastShown_s, paused_at_s - std::min(one_s, other_s));
}

void CurveTime::scroll_back(double by_s, double oldest_s) noexcept {
  if (!paused) return;
  const double most_s = std::max(0.0, paused_at_s - shown_s - oldest_s);
  scrolled_back_s = std::clamp(scrolled_back_s + by_s, 0.0, std::max(most_s, scrolled_back_s));
}

}  // namespace palpate
