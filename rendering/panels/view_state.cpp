#include "rendering/panels/view_state.h"

#include <algorithm>
#include <utility>

namespace palpate {

void RecordingRoles::add(OpenedRecording recording) {
  std::erase_if(recordings, [&](const OpenedRecording& other) { return other.path == recording.path; });
  recordings.push_back(std::move(recording));
  if (recordings.size() > 1) make_test(recordings.size() - 1);
}

void RecordingRoles::make_test(std::size_t index) {
  for (OpenedRecording& one : recordings)
    if (one.role == OpenedRecording::Role::test) one.role = OpenedRecording::Role::train;
  recordings[index].role = OpenedRecording::Role::test;
}

std::vector<std::string> RecordingRoles::training() const {
  std::vector<std::string> paths;
  for (const OpenedRecording& one : recordings)
    if (one.role == OpenedRecording::Role::train) paths.push_back(one.path);
  return paths;
}

std::string RecordingRoles::test() const {
  for (const OpenedRecording& one : recordings)
    if (one.role == OpenedRecording::Role::test) return one.path;
  return {};
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
