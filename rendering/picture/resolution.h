// Antialiasing of the 3-D view; text and curves have their own. A graphics card uses multisampling. With a software
// renderer each sample would cost as much as a pixel: there the edges of the finished picture are filtered
// (assets/shaders/edges.frag). The static picture is drawn and filtered once; a frame draws and filters only the
// parts in which something moves. The picture may have fewer pixels than the window and is enlarged.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "rendering/picture/shader.h"

namespace palpate {

// A rectangle in pixels of a framebuffer; the origin is the lower left corner.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
};

// A framebuffer object with colour and depth.
class Pixels {
 public:
  // `samples` per pixel, at most the 4 that OpenGL 3.3 guarantees; 0: no multisampling, and `colour` is a texture.
  explicit Pixels(int samples) : samples_(samples) {}
  Pixels(const Pixels&) = delete;
  Pixels& operator=(const Pixels&) = delete;
  ~Pixels() { release(); }

  // Makes it the target of drawing. The contents are kept unless the size changes.
  void draw_into(int width, int height);
  // Copies colour and depth of `part` into `other`, which has the same size, and makes `other` the target of drawing.
  void copy_to(const Pixels& other, const Viewport& part) const;
  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  unsigned framebuffer() const noexcept { return framebuffer_; }
  unsigned colour() const noexcept { return colour_; }

 private:
  void make();
  void release();

  int samples_, width_ = 0, height_ = 0;
  unsigned framebuffer_ = 0, colour_ = 0;
  unsigned buffers_[2] = {};  // of colour, with several samples, and of depth
};

enum class Smoothing { samples, filter };
// The filter for a software renderer, else multisampling. `renderer`: its name as OpenGL reports it.
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
  // static picture is kept. With multisampling, draw all parts in each frame.
  void begin(const Viewport& viewport, float scale);
  // Draw the static picture between these two calls. It is kept until the size changes.
  void begin_still();
  void end_still();
  // Begins a frame with the static picture. Draw only inside `parts` (in pixels of the picture) afterwards.
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

// Selects the resolution of the 3-D view for a software renderer: it is lower while frames are late.
class Resolution {
 public:
  static constexpr float kLeast = 0.67F;  // smallest `scale`

  // Adds the computation time of a frame, without the wait for the next one.
  void add(double busy_s) noexcept;
  float scale() const noexcept;  // share of the pixels per side, kLeast to 1

 private:
  int step_ = 0;  // 0: full resolution
  int frames_ = 0;
  int good_ = 0;  // successive periods of 60 frames in which the next larger resolution would fit
  double busy_s_ = 0.0;
};

}  // namespace palpate
