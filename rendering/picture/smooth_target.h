// Antialiasing of the 3-D view; text and curves have their own. A graphics card uses multisampling. With a software
// renderer each sample would cost as much as a pixel: there the edges of the finished picture are filtered
// (assets/shaders/edges.frag), static parts are drawn once, and the picture may have fewer pixels and is enlarged.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <optional>
#include <string_view>

#include "rendering/picture/pixels.h"
#include "rendering/picture/shader.h"

namespace palpate {

// In pixels of the framebuffer; the origin is the lower left corner.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Viewport&) const = default;
};

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

  bool filters() const noexcept { return filter_.has_value(); }
  // Size of the picture after `begin`, pixels.
  int width() const noexcept { return pixels_.width(); }
  int height() const noexcept { return pixels_.height(); }
  // Begins the picture for a part of the window. With the filter it has `scale` (0..1) times the pixels per side. Where
  // the driver refuses, drawing goes directly into the window.
  void begin(const Viewport& viewport, float scale);
  // Begins the static part, which is kept for `use_still`. False: the driver refuses; draw the static part in each
  // frame.
  bool begin_still();
  // Copies colour and depth of the static part into the picture. The next draws go on top of it.
  void use_still();
  // Copies the picture to the window and makes the window the target again.
  void end();

 private:
  void filter_edges(const Viewport& to) const;

  std::optional<EdgeFilter> filter_;
  Viewport viewport_;
  Pixels pixels_, still_, smoothed_;
  bool refused_ = false;
  unsigned no_vertices_ = 0;  // vertex array without buffers, for a triangle
};

}  // namespace palpate
