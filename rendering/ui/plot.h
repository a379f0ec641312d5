// A plot with axes on an ImDrawList.
// Thread guarantee: the window's thread, inside a frame.
#pragma once

#include <imgui.h>

#include <string>
#include <vector>

#include "rendering/ui/ui.h"

namespace palpate {

struct Range {
  double from = 0.0, to = 1.0;
};

// The smallest step of 1, 2 or 5 times a power of ten that gives at most `most` intervals.
double tick_step(double span, int most) noexcept;
// Rounds up to the next 1, 1.2, 1.5, 2, 3, 4, 5, 6, 8 or 10 times a power of ten; 1 for values <= 0.
double round_up(double value) noexcept;

// The same line with fewer points: those within a third of a pixel of it are left out. A software renderer needs as
// much time for the two triangles of a piece of a line as for two hundred pixels.
std::vector<ImVec2> simplified(const std::vector<ImVec2>& points);

struct PlotAxes {
  Range x, y;
  const char* x_unit = "";  // appended to the last label
  const char* y_unit = "";
  bool decades = false;   // coordinates are decimal logarithms of the labelled values
  double x_least = -1e9;  // labels below it are left out
};

// Lengths of the pieces of a dashed line along x and of the gaps after them, pixels; without a gap it is solid.
struct Dashes {
  float dash = 0.0F, gap = 0.0F;
};

class LivePlot {
 public:
  // Reserves `size` at the cursor, draws grid and labels, and begins to clip to the frame.
  LivePlot(const UiStyle& style, const ImVec2& size, const PlotAxes& axes);
  ~LivePlot();
  LivePlot(const LivePlot&) = delete;
  LivePlot& operator=(const LivePlot&) = delete;

  float x_px(double x) const noexcept;
  float y_px(double y) const noexcept;
  double x_at(float px) const noexcept;
  float left() const noexcept { return low_.x; }
  float right() const noexcept { return high_.x; }
  float top() const noexcept { return low_.y; }
  float bottom() const noexcept { return high_.y; }
  bool hovered() const noexcept;
  bool owns_drag() const noexcept;  // the last drag began in it
  ImDrawList& list() const noexcept { return *list_; }

  // `start_px`: the x at which a dash begins, on the plot or not.
  void line(const std::vector<ImVec2>& points, ImU32 colour, float thickness, const Dashes& dashes = {},
            float start_px = 0.0F) const;
  // Fills the area between two curves with the same x values.
  void band(const std::vector<ImVec2>& upper, const std::vector<ImVec2>& lower, ImU32 colour) const;
  // Fills a range of y over the whole width: the differences below one JND.
  void jnd_band(double from, double to) const;
  void level(double y, ImU32 colour, float thickness) const;

 protected:
  const UiStyle& style_;

 private:
  std::vector<double> ticks(const Range& range, int most) const;  // about `most`, in decades those of 1, 2 and 5
  std::string label(double value, const char* unit) const;
  void draw_y_axis() const;
  void dashed(const std::vector<ImVec2>& points, ImU32 colour, float thickness, const Dashes& dashes,
              float start_px) const;
  void draw_x_axis() const;

  ImDrawList* list_;
  ImVec2 low_, high_;
  PlotAxes axes_;
};

}  // namespace palpate
