// A part of a picture drawn with several samples a pixel, so that edges are smooth:
// begun with what is there, put back over it in the end. Only the part that
// something stands in, for every sample costs where the processor draws.
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
  ~SmoothTarget();

  // Makes it the target of drawing, with `part` of the framebuffer `source` (0: the
  // window) whose lower left corner is at `at_x`, `at_y` as its lower left part, and
  // no depth yet. False: the driver cannot, draw to the window instead.
  bool begin(unsigned source, int at_x, int at_y, const Viewport& part);
  // Puts it over `part` of the framebuffer `target`, which is what is drawn to again.
  void end(unsigned target, const Viewport& part) const;

 private:
  bool resize(int width, int height);
  void release();

  unsigned framebuffer_ = 0;
  unsigned buffers_[2] = {0, 0};  // colour, depth
  int width_ = 0;
  int height_ = 0;
  bool refused_ = false;
};

}  // namespace palpate
