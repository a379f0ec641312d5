// The picture with smooth edges, for itself alone: text and curves have smooth edges of their own.
// A graphics card takes several samples a pixel. Where the processor draws, each sample costs as much as a pixel: there
// the edges of the finished picture are filtered (assets/shaders/edges.frag), what stands still is drawn
// once, and a picture of fewer pixels is enlarged.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <optional>
#include <string_view>

#include "rendering/picture/pixels.h"
#include "rendering/picture/shader.h"

namespace palpate {

// In pixels of the framebuffer, from its lower left corner.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Viewport&) const = default;
};

enum class Smoothing { samples, filter };
// Of the renderer that OpenGL names: the filter where it is a program.
Smoothing smoothing_for(std::string_view renderer) noexcept;

struct EdgeFilter {
  Shader find, smooth;  // "find_edges", "edges"
};

class SmoothTarget {
 public:
  // `filter`: none for several samples a pixel.
  explicit SmoothTarget(std::optional<EdgeFilter> filter);
  SmoothTarget(const SmoothTarget&) = delete;
  SmoothTarget& operator=(const SmoothTarget&) = delete;
  ~SmoothTarget();

  bool filters() const noexcept { return filter_.has_value(); }
  // Of what is drawn into after `begin`, pixels.
  int width() const noexcept { return pixels_.width(); }
  int height() const noexcept { return pixels_.height(); }
  // What follows is drawn for that part of the window, at `scale` of its pixels a side, 0..1, where edges are
  // filtered. Where the driver refuses, straight into the window.
  void begin(const Viewport& viewport, float scale);
  // What follows stands still, and is kept for `use_still`. False: it is not, draw it always.
  bool begin_still();
  // What stood still is in the picture, colour and depth, and what follows comes on top.
  void use_still();
  // Onto the window, which is drawn to again.
  void end();

 private:
  void filter_edges(const Viewport& to) const;

  std::optional<EdgeFilter> filter_;
  Viewport viewport_;
  Pixels pixels_, still_, smoothed_;
  bool refused_ = false;
  unsigned no_vertices_ = 0;  // three corners need no buffer
};

}  // namespace palpate
