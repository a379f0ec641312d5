// Antialiasing of the 3-D view; text and curves have their own. A graphics card uses multisampling. With a software
// renderer each sample would cost as much as a pixel: there the edges of the finished picture are filtered
// (assets/shaders/edges.frag). The static picture is drawn and filtered once; a frame draws and filters only the
// parts in which something moves. The picture may have fewer pixels than the window and is enlarged.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "rendering/picture/pixels.h"
#include "rendering/picture/shader.h"

namespace palpate {

enum class Smoothing { samples, filter };
// For the renderer's name of OpenGL: the filter for a software renderer, else multisampling.
Smoothing smoothing_for(std::string_view renderer) noexcept;

struct EdgeFilter {
  Shader find, smooth;  // "find_edges", "edges"
};

class SmoothTarget {
 public:
  // `filter`: empty for multisampling.
  explicit SmoothTarget(std::optional<EdgeFilter> filter);
  SmoothTarget(const SmoothTarget&) = delete;
  SmoothTarget& operator=(const SmoothTarget&) = delete;
  ~SmoothTarget();

  // The edge filter changes pixels up to this distance from what is drawn.
  static constexpr float kReach_px = 15.0F;
  bool filters() const noexcept { return filter_.has_value(); }
  // Size of the picture after `begin`, pixels.
  int width() const noexcept { return pixels_.width(); }
  int height() const noexcept { return pixels_.height(); }
  // Begins the picture for a part of the window. With the filter it has `scale` (0..1) times the pixels per side, and a
  // static picture is kept. Without it, draw all parts in each frame.
  void begin(const Viewport& viewport, float scale);
  // Between the two calls the static picture is drawn. It is kept until the size changes.
  void begin_still();
  void end_still();
  // Begins a frame from the static picture. All that is then drawn must be inside `parts`, in pixels of the picture.
  void use_still(std::vector<Viewport> parts);
  // Copies the picture to the window and makes the window the target again.
  void end();

 private:
  bool is_enlarged() const noexcept;
  void enlarge(const std::vector<Viewport>& parts);
  void filter_edges(const Pixels& picture, const std::vector<Viewport>& parts);

  std::optional<EdgeFilter> filter_;
  Viewport viewport_;
  Pixels pixels_, still_;
  Pixels smoothed_;              // the filtered picture, upside down; see `end`
  Pixels enlarged_;              // `smoothed_` in the size of the window
  std::vector<Viewport> parts_;  // in which this frame, or the one before, differs from the static picture
  std::vector<Viewport> drawn_;  // `parts` of this frame
  unsigned no_vertices_ = 0;     // vertex array without buffers, for a triangle
};

}  // namespace palpate
