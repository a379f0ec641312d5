#include "rendering/panels/panel_health.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "rendering/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr std::size_t kFaultsShown = 6;
constexpr double kStall_s = 0.05;
constexpr double kFewFrames_per_s = 50.0;
// A larger share of missed deadlines is reported.
constexpr double kManyMissed = 0.01;

std::string text_of(const char* pattern, double a, double b = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

void row(const char* name, const TimePercentiles& times) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(name);
  for (const double value : {times.p50_us, times.p99_us, times.p99_9_us, times.max_us}) {
    ImGui::TableNextColumn();
    ImGui::Text("%.0f", value);
  }
}

void draw_times(const LoopStatistics& statistics, const FrameFigures& frames) {
  ImGui::Text("%llu ticks, the last %.1f ms ago", static_cast<unsigned long long>(statistics.ticks),
              1e3 * statistics.age_s);
  if (!ImGui::BeginTable("times", 5, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_NoSavedSettings)) return;
  for (const char* heading : {"microseconds", "p50", "p99", "p99.9", "max"}) ImGui::TableSetupColumn(heading);
  ImGui::TableHeadersRow();
  row("lateness", statistics.lateness);
  row("tick", statistics.tick);
  row("frame", frames.times.percentiles());
  ImGui::EndTable();
}

void draw_faults(const HealthView& health, const UiStyle& style) {
  const std::vector<FaultEvent>& faults = health.faults;
  if (faults.empty()) {
    ImGui::TextDisabled("no fault so far");
    return;
  }
  const std::size_t first = faults.size() > kFaultsShown ? faults.size() - kFaultsShown : 0;
  for (std::size_t i = faults.size(); i-- > first;) {
    ImGui::TextColored(paint(style.colours().fault), "%.0f s ago",
                       std::max(0.0, health.newest.loop_time_s - faults[i].loop_time_s));
    ImGui::SameLine();
    ImGui::TextWrapped("%s%s", faults[i].text.c_str(),
                       faults[i].count > 1 ? (" (" + std::to_string(faults[i].count) + " times)").c_str() : "");
  }
}

}  // namespace

std::string device_line(const HealthView& health) {
  const DeviceHealth& device = health.newest.device;
  const double stiffness_share = health.newest.stiffness_share;
  const bool real = device.zeroing != Zeroing::not_needed || device.interval_s > 0.0;
  const bool softened = stiffness_share < 0.995;
  if (!real && device.faults == 0 && !softened) return {};
  std::string line = health.device_name + text_of(": sample %.1f ms old", 1e3 * device.sample_age_s);
  if (device.interval_s > 0.0) line += text_of(", %.0f samples a second", 1.0 / device.interval_s);
  if (!std::isnan(device.round_trip_s)) line += text_of(", round trip %.1f ms", 1e3 * device.round_trip_s);
  if (softened) {
    line += text_of(", force %.1f ms late: rendered at %.0f %% of the stiffness, because more would oscillate",
                    health.newest.lag_ms, 100.0 * stiffness_share);
  }
  line += text_of(", motor heat %.0f %%", 100.0 * health.newest.heat_share);
  return line;
}

float health_height(const HealthView& health, const ViewState& view) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  // The line may be wider than a narrow panel.
  const std::string device = device_line(health);
  const float room = ImGui::GetContentRegionAvail().x;
  float height = 3.0F * line;
  if (!device.empty())
    height += ImGui::CalcTextSize(device.c_str(), nullptr, false, room).y + ImGui::GetStyle().ItemSpacing.y;
  if (!view.details) return height;
  const float fix = health.scheduling.fix.empty() ? 0.0F : 8.0F;
  const auto faults = static_cast<float>(std::clamp<std::size_t>(health.faults.size(), 1, kFaultsShown));
  return height + (fix + 7.0F + faults) * line;
}

HealthWords health_words(const HealthView& health, double recent_fps, bool details) {
  const LoopStatistics& statistics = health.loop;
  if (statistics.ticks > 0 && statistics.age_s > kStall_s)
    return {text_of("The loop stands still: last tick %.1f s ago, the tool gets no new force", statistics.age_s), true};
  if (const auto words = device_fault_words(health.newest.device.faults); !words.empty())
    return {"Device: " + words.front(), true};
  if (const std::vector<std::string>& words = health.alarms; !words.empty()) {
    const std::string more = words.size() > 1 ? " (and " + std::to_string(words.size() - 1) + " more)" : std::string();
    return {"Earlier: " + words.front() + more, true, true};
  }
  const double missed = health.missed_of_late;
  if (details && missed > kManyMissed) {
    return {text_of("%.1f %% of the recent deadlines missed: close other programs", 100.0 * missed) +
                (health.scheduling.realtime ? "" : ", or allow real-time priority"),
            true};
  }
  if (recent_fps > 0.0 && recent_fps < kFewFrames_per_s) {
    // A slow picture does not affect the force, so it is not a fault.
    const std::string slow = text_of("%.0f frames a second: a slow picture, ", recent_fps);
    if (statistics.missed_deadlines == 0) return {slow + "the force is not affected", false};
    return {slow + std::to_string(statistics.missed_deadlines) + " deadlines missed", false};
  }
  return {text_of("tick p99 %.0f us, late p99 %.0f us", statistics.tick.p99_us, statistics.lateness.p99_us) +
              ", missed " + std::to_string(statistics.missed_deadlines) + text_of(", %.0f fps", recent_fps),
          false};
}

void draw_health(const HealthView& health, ViewState& view, const UiStyle& style) {
  section_title(style, "LOOP");
  ImGui::SameLine();
  // ImGuiIO::Framerate has only the frames in which texts were drawn.
  const double frame_s = view.frames.recent_s;
  const HealthWords words = health_words(health, frame_s > 0.0 ? 1.0 / frame_s : 0.0, view.details);
  const auto wrapped = [](const Rgb& colour, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, paint(colour));
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
  };
  const Palette& p = style.colours();
  wrapped(words.problem ? p.fault : p.quiet, words.text + (words.past ? ". C clears this." : ""));
  if (ImGui::IsItemClicked()) view.details = !view.details;
  tip("How well the 1000 Hz loop keeps its time. L shows all figures and faults.");
  const RtStatus& scheduling = health.scheduling;
  ImGui::TextDisabled("scheduling: %s", scheduling.scheduling.c_str());
  if (!scheduling.fix.empty()) {
    ImGui::SameLine();
    ImGui::TextDisabled(view.details ? "" : "(L: how to get better)");
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", scheduling.fix.c_str());
  }
  if (const std::string line = device_line(health); !line.empty()) {
    wrapped(p.quiet, line);
    tip("The device: age of its newest sample, time from a force to the report that confirms it, and how much of "
        "the motor's thermal budget is used.");
  }
  if (!view.details) return;
  if (!scheduling.fix.empty()) ImGui::TextWrapped("%s", scheduling.fix.c_str());
  draw_times(health.loop, view.frames);
  draw_faults(health, style);
}

}  // namespace palpate
