// The parts of the window: its layout; the panel beside the picture (panel.cpp arranges it, panel_force.cpp has the
// curves, panel_models.cpp the table, panel_speed.cpp the plot of error against time); the texts and controls over the
// picture (scene_overlay.cpp); and the dialogs in its middle (dialogs.cpp). Each reads a WindowView and calls
// WindowActions. Thread guarantee: the window's thread, inside a frame; functions without a window are pure.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "rendering/panels/time_plot.h"
#include "rendering/panels/window_view.h"
#include "rendering/picture/block_view.h"
#include "rendering/ui/plot.h"
#include "rendering/ui/ui.h"

namespace palpate {

// A part of the window, in ImGui's coordinates.
struct SceneArea {
  ImVec2 at, size;
  bool holds(const ImVec2& point) const {
    return point.x >= at.x && point.y >= at.y && point.x < at.x + size.x && point.y < at.y + size.y;
  }
};

struct WindowLayout {
  SceneArea scene;
  SceneArea panel;
};

// The panel is beside the scene; below it where the width is less than 1.1 times the height.
WindowLayout lay_out(const ImVec2& window);

// The colour of a model's method, in another shade for each further model of that method.
Rgb slot_colour(const ModelsView& models, std::size_t slot, Theme theme);
// The dashes of its curves: the nth model of a method has the nth pattern of the method.
Dashes slot_dashes(const ModelsView& models, std::size_t slot);
// Draws the mark of a model: a disc, hollow for the recipe of the paper (2009).
void draw_mark(ImDrawList& list, const ImVec2& middle, float radius, bool paper, ImU32 colour, const UiStyle& style);

// text_size returns the size of `text`, text_at draws it on the picture. `wrap`: width of a line; 0: not wrapped.
ImVec2 text_size(ImFont* font, const std::string& text, float wrap = 0.0F);
void text_at(ImFont* font, const ImVec2& at, ImU32 colour, const std::string& text, float wrap = 0.0F);

// `text`, cut at a blank and with "..." at its end where it is wider than `room` pixels.
std::string fitting(const std::string& text, float room);
// Breaks lines of `width` at blanks only; Dear ImGui would also break after the decimal point of a number. `font`:
// null: the present one.
std::string in_lines(const std::string& text, float width, ImFont* font = nullptr);
// Draws secondary text on the rest of the line. Where it does not fit it is cut, and a tooltip has all of it.
void quiet_words(const std::string& text);
// Begins an ImGui window that fills `area`. Call ImGui::End afterwards.
void begin_panel(const char* name, const SceneArea& area);
void section_title(const UiStyle& style, const char* title);
// A tooltip for the last item, above or below it; one of several lines beside the window, not over what it explains.
void tip(const char* text);

// The share of the panel's width for what stands left of a plot against depth or force.
inline constexpr float kLeftShare = 0.6F;
// The curves: force against time with the JND band, force against depth, and the difference of every model from the
// reference in JND.
class ForceCurves {
 public:
  void draw(const WindowView& shown, ViewState& view, const UiStyle& style, float force_height, float error_height);

  const CurveColumns& columns() const noexcept { return columns_; }

 private:
  CurveColumns columns_;
  double force_scale_N_ = 1.0;  // upper end of the force axes; changes gradually
};

// The table of models. A click on a row makes its model the active one, with Shift it compares it with the active one
// alone; a click on its error shows the moment of its largest one. A right click on a model of another material offers
// to compare it. The last row adds a model. Where it is narrow, columns are dropped in this order: error in mN,
// centres, force, share within the JND. Name, 99 % error and time always stay.
void draw_model_table(const WindowView& shown, ViewState& view, const UiStyle& style, float height,
                      const WindowActions& actions);
// Which other models have the forces of this one, and why; empty: none. Begins with a line break.
std::string equal_words(const ModelInfo& info);

// The plot of error against time: one dot for each model, with the columns "99 % error / JND" and "ns" of the table.
void draw_speed(const ModelsView& models, const UiStyle& style, const ImVec2& size);
// The plot of error against force: mean + standard deviation of the error over the JND in each bin of the force.
void draw_against_force(const ModelsView& models, const UiStyle& style, const ImVec2& size);
// Its axes: decimal logarithms of the time of a tick, ns, and of the error over the JND, with ranges that show all
// dots, their intervals and paths, and the JND. Without a model with errors the ranges are those of usual models.
PlotAxes speed_axes(const ModelsView& models);

// The status line of the loop.
struct HealthWords {
  std::string text;
  bool problem = false;
  bool past = false;  // a past alarm that is not acknowledged (LiveSession::reset_figures)
};
// `recent_fps`: frames per second, of about the last 60 frames; 0: unknown. `details`: the reader is an engineer, to
// whom missed deadlines are a problem.
HealthWords health_words(const HealthView& health, double recent_fps, bool details);
// Age of the sample, rate, round trip, stiffness limit and heat of a real device, or of one with a fault; else empty.
std::string device_line(const HealthView& health);

void draw_panel(ForceCurves& curves, const WindowView& shown, ViewState& view, const UiStyle& style,
                const SceneArea& area, const WindowActions& actions);

// The name of a key of GLFW: "Space", "H"; empty where it is neither printable nor in the list of names.
std::string key_name(int key);
// The keys in the list and in tooltips: "Ctrl+Q", "H, /".
std::string shown_keys(const WindowCommand& command);
const std::string& shown_label(const WindowCommand& command);

// Draws the button with its tooltip at the cursor; `side`: at least its height and width. Returns whether it was
// pressed.
bool command_button(const WindowCommand& command, float side = 0.0F);

// The state of a recording; empty without one.
std::string recording_words(const RecordingStatus& recording);

// The hint how to press, until the user has done it; else empty.
std::string press_hint(const WindowView& shown, ViewState& view);
// The part of the picture between the headline and the big number, for the blocks.
SceneArea stage_of(const WindowView& shown, const ViewState& view, const UiStyle& style, const SceneArea& area);

void draw_overlay(const WindowView& shown, const BlockView& blocks, ViewState& view, const UiStyle& style,
                  const SceneArea& area, const WindowActions& actions);
void draw_dialogs(const WindowView& shown, ViewState& view, const WindowActions& actions);

// The entries of a folder that can be opened: its folders ("name/"), then its files.
std::vector<std::string> pickable_files(const std::string& folder);

}  // namespace palpate
