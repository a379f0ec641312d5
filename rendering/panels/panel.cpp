#include "rendering/panels/panel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <sstream>

#include "scenes/worker/model_worker.h"

namespace palpate {
namespace {

void draw_centres(const ModelsView& models, ViewState& view, const WindowActions& actions) {
  std::vector<std::size_t> slots = models.listed();
  std::erase_if(slots, [&](std::size_t slot) { return !models.slots[slot].takes_centres; });
  const bool refitting = std::ranges::any_of(slots, [&](std::size_t slot) { return models.slots[slot].refitting; });
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("centres");
  ImGui::SameLine();
  int centres = models.slots[slots.front()].centres;
  for (const std::size_t slot : slots) centres = std::max(centres, models.slots[slot].centres);
  if (view.requested_centres > 0 && (ImGui::IsMouseDown(ImGuiMouseButton_Left) || refitting))
    centres = view.requested_centres;
  ImGui::SetNextItemWidth(-4.0F * ImGui::GetFontSize());
  if (ImGui::SliderInt("##centres", &centres, 1, kMostCentres, "%d",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp)) {
    view.requested_centres = centres;
    for (const std::size_t slot : slots) actions.models().refit(slot, centres);
  }
  tip("Fits every model that has centres again with this number of centres.\n"
      "Drag to the left, and watch the curves leave their band and the dots move.");
  ImGui::SameLine();
  ImGui::TextDisabled("%s", refitting ? "fits ..." : "");
}

constexpr std::size_t kFaultsShown = 6;
constexpr double kFewFrames_per_s = 50.0;
constexpr std::uint64_t kStart_ticks = 10'000;
// A larger share of missed deadlines is reported.
constexpr double kManyMissed = 0.01;

std::string text_of(const char* pattern, double a, double b = 0.0) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
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
  tip("How well the 1000 Hz loop keeps its time. L shows the faults.");
  const RtStatus& scheduling = health.scheduling;
  ImGui::TextDisabled("scheduling: %s", scheduling.scheduling.c_str());
  if (!scheduling.fix.empty()) {
    ImGui::SameLine();
    ImGui::TextDisabled(view.details ? "" : "(L: how to get better)");
    tip(scheduling.fix.c_str());
  }
  if (const std::string line = device_line(health); !line.empty()) {
    wrapped(p.quiet, line);
    tip("The device: age of its newest sample, time from a force to the report that confirms it, and how much of "
        "the motor's thermal budget is used.");
  }
  if (!view.details) return;
  if (!scheduling.fix.empty()) ImGui::TextWrapped("%s", scheduling.fix.c_str());
  draw_faults(health, style);
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
  line += text_of(", force %.1f ms late", health.newest.delay_ms);
  if (softened)
    line += text_of(": rendered at %.0f %% of the stiffness, because more would oscillate", 100.0 * stiffness_share);
  line += text_of(", motor heat %.0f %%", 100.0 * health.newest.heat_share);
  return line;
}

HealthWords health_words(const HealthView& health, double recent_fps, bool details) {
  const LoopStatistics& statistics = health.loop;
  if (statistics.ticks > 0 && statistics.age_s > FaultLog::kStall_s)
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
  // The first seconds have the start in them.
  if (recent_fps > 0.0 && recent_fps < kFewFrames_per_s && statistics.ticks > kStart_ticks) {
    // A slow picture does not affect the force, so it is not a fault.
    return {text_of("%.0f frames a second: a slow picture, ", recent_fps) +
                (statistics.missed_deadlines == 0 ? "the force is not affected"
                                                  : std::to_string(statistics.missed_deadlines) + " deadlines missed"),
            false};
  }
  return {text_of("tick p99 %.0f us, late p99 %.0f us", statistics.tick.p99_us, statistics.lateness.p99_us) +
              ", missed " + std::to_string(statistics.missed_deadlines) +
              (recent_fps > 0.0 ? text_of(", %.0f fps", recent_fps) : ""),
          false};
}

void draw_panel(ForceCurves& curves, const WindowView& shown, ViewState& view, const UiStyle& style,
                const SceneArea& area, const WindowActions& actions) {
  begin_panel(kPanelWindow, area);
  const ModelsView& models = shown.models;
  const float line = ImGui::GetTextLineHeightWithSpacing();
  // The plots share the height that the parts of fixed size leave.
  // The loop's lines keep room for three, so that nothing moves when one of them is wrapped.
  const float health_room = std::max(3.0F * line, view.health_px);
  const float rows = static_cast<float>(std::clamp<std::size_t>(models.listed().size(), 2, 8)) +
                     (shown.scene->has_material() ? 2.0F : 1.0F);
  const float table = rows * (ImGui::GetTextLineHeight() + 2.0F * ImGui::GetStyle().CellPadding.y + 1.0F) +
                      0.28F * ImGui::GetFontSize() + 3.0F;
  const float titles = line * 3.4F;
  const bool has_centres =
      std::ranges::any_of(models.drawn(), [&](std::size_t i) { return models.slots[i].takes_centres; });
  const float centres = has_centres ? ImGui::GetFrameHeightWithSpacing() : 0.0F;
  const float rest = std::max(6.0F * line, ImGui::GetContentRegionAvail().y - health_room - table - centres - titles);
  // Where the panel is too low for three plots, the last one goes.
  const bool bins = rest > (view.details ? 14.0F : 11.0F) * line;
  curves.draw(shown, view, style, rest * (bins ? 0.34F : 0.52F), rest * (bins ? 0.29F : 0.48F));
  draw_model_table(shown, view, style, table, actions);
  if (centres > 0.0F) draw_centres(models, view, actions);
  if (bins) {
    const float all = ImGui::GetContentRegionAvail().x, height = rest * 0.36F;
    const bool both = all > 33.0F * ImGui::GetFontSize();  // there is room for the labels of both
    const float left = both ? kLeftShare * all : all;
    section_title(style, "ERROR / JND AGAINST TIME");
    ImGui::SameLine(both ? left + ImGui::GetStyle().WindowPadding.x : 0.0F);
    both ? section_title(style, "AGAINST FORCE") : quiet_words(models.counted);
    tip(("Over " + models.counted + ". Against force: mean + standard deviation in steps of two JND.").c_str());
    ImGui::BeginGroup();
    draw_speed(models, style, {left - (both ? ImGui::GetStyle().ItemSpacing.x : 0.0F), height});
    ImGui::EndGroup();
    if (both) {
      ImGui::SameLine();
      draw_against_force(models, style, {all - left, height});
    }
  }
  const float above_px = ImGui::GetCursorPosY();
  draw_health(shown.health, view, style);
  view.health_px = ImGui::GetCursorPosY() - above_px;
  ImGui::End();
}

constexpr float kSceneShare = 0.6F;    // of the width
constexpr float kSceneHeight = 0.45F;  // of the height, above the panel
constexpr float kTall = 1.1F;          // ratio of width to height below which the panel is below the scene

WindowLayout lay_out(const ImVec2& window) {
  WindowLayout layout;
  if (window.x < kTall * window.y) {
    const float height = std::round(kSceneHeight * window.y);
    layout.scene = {{0.0F, 0.0F}, {window.x, height}};
    layout.panel = {{0.0F, height}, {window.x, window.y - height}};
  } else {
    const float width = std::round(kSceneShare * window.x);
    layout.scene = {{0.0F, 0.0F}, {width, window.y}};
    layout.panel = {{width, 0.0F}, {window.x - width, window.y}};
  }
  return layout;
}

ImVec2 text_size(ImFont* font, const std::string& text, float wrap) {
  return font->CalcTextSizeA(height_of(font), 1e6F, wrap, text.c_str());
}

void text_at(ImFont* font, const ImVec2& at, ImU32 colour, const std::string& text, float wrap) {
  ImGui::GetBackgroundDrawList()->AddText(font, height_of(font), at, colour, text.c_str(), nullptr, wrap);
}

std::string fitting(const std::string& text, float room) {
  if (ImGui::CalcTextSize(text.c_str()).x <= room) return text;
  std::string cut = text;
  while (!cut.empty()) {
    const std::size_t blank = cut.rfind(' ');
    cut.resize(blank == std::string::npos ? 0 : blank);
    const std::string shown = cut + " ...";
    if (ImGui::CalcTextSize(shown.c_str()).x <= room) return shown;
  }
  return {};
}

std::string in_lines(const std::string& text, float width, ImFont* font) {
  if (font == nullptr) font = ImGui::GetFont();
  std::string lines, line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = line.empty() ? word : line + " " + word;
    const bool fits = line.empty() || text_size(font, longer).x <= width;
    if (!fits) lines += line + "\n";
    line = fits ? longer : word;
  }
  return lines + line;
}

void quiet_words(const std::string& text) {
  const std::string shown = fitting(text, ImGui::GetContentRegionAvail().x);
  ImGui::TextDisabled("%s", shown.c_str());
  if (shown != text) tip(text.c_str());
}

void begin_panel(const char* name, const SceneArea& area) {
  ImGui::SetNextWindowPos(area.at);
  ImGui::SetNextWindowSize(area.size);
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground);
}

void section_title(const UiStyle& style, const char* title) {
  ImGui::TextColored(paint(style.colours().text), "%s", title);
}

namespace {

// Which of the listed models of its method this is, from 0.
std::size_t among_its_method(const ModelsView& models, std::size_t slot) {
  const auto hue = [&](std::size_t i) { return method_colour(models.slots[i].method, Theme::light); };
  std::size_t which = 0;
  for (const std::size_t i : models.listed()) {
    if (i == slot) break;
    if (hue(i) == hue(slot)) ++which;
  }
  return which;
}

}  // namespace

Rgb slot_colour(const ModelsView& models, std::size_t slot, Theme theme) {
  return method_colour(models.slots[slot].method, theme, among_its_method(models, slot));
}

// A method's pattern follows from its place in the table of methods, so that it is the same in every session.
Dashes slot_dashes(const ModelsView& models, std::size_t slot) {
  constexpr Dashes kPatterns[] = {{0.0F, 0.0F}, {14.0F, 4.0F}, {7.0F, 3.0F}, {3.0F, 3.0F}, {22.0F, 7.0F}};
  const std::vector<MethodChoice>& methods = method_choices();
  const auto method = std::ranges::find(methods, models.slots[slot].method, &MethodChoice::family);
  const auto place = static_cast<std::size_t>(method - methods.begin());
  return kPatterns[(place + among_its_method(models, slot)) % std::size(kPatterns)];
}

void draw_mark(ImDrawList& list, const ImVec2& middle, float radius, bool paper, ImU32 colour, const UiStyle& style) {
  list.AddCircleFilled(middle, radius, colour);
  if (paper) list.AddCircleFilled(middle, 0.5F * radius, ink(style.colours().panel));
}

void tip(const char* text) {
  if (!ImGui::IsItemHovered()) return;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax(), all = ImGui::GetIO().DisplaySize;
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const float gap = 0.3F * ImGui::GetFontSize(), room = ImGui::GetWindowPos().x - gap - 2.0F * padding.x;
  ImVec2 size = ImGui::CalcTextSize(text);
  // Of several lines.
  const bool beside = size.y > 1.5F * ImGui::GetFontSize() && room > 20.0F * ImGui::GetFontSize();
  if (beside && size.x > room) size = ImGui::CalcTextSize(text, nullptr, false, room);
  const float wide = size.x + 2.0F * padding.x, tall = size.y + 2.0F * padding.y, above = low.y - gap - tall;
  const float x = beside ? ImGui::GetWindowPos().x - gap - wide : low.x;
  const float y = beside ? low.y : above >= 0.0F ? above : high.y + gap;
  ImGui::SetNextWindowPos(
      {std::clamp(x, 0.0F, std::max(0.0F, all.x - wide)), std::clamp(y, 0.0F, std::max(0.0F, all.y - tall))});
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(padding.x + size.x + 1.0F);
  ImGui::TextUnformatted(text);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace palpate
