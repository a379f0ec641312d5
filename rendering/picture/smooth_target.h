// Several samples a pixel, so that edges are smooth, for the picture alone: text and
// curves have smooth edges of their own, and where the processor draws every sample costs.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

namespace palpate {

// In pixels of the framebuffer, from its lower left corner.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
};

class SmoothTarget {
 public:
  SmoothTarget() = default;
  SmoothTarget(const SmoothTarget&) = delete;
  SmoothTarget& operator=(const SmoothTarget&) = delete;
  ~SmoothTarget() { release(); }

  // What follows is drawn into samples of its own, the viewport's size; nothing is in them
  // yet. Where the driver refuses, into the window's viewport.
  void begin(const Viewport& viewport);
  // Onto the window, which is drawn to again.
  void end() const;

 private:
  bool make();
  void release();

  Viewport viewport_;
  unsigned framebuffer_ = 0;      // 0: refused, or not yet made
  unsigned buffers_[2] = {0, 0};  // colour, depth
};

}  // namespace palpate
