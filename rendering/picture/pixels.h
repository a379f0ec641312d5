// A framebuffer object whose colours are a texture. Its first row is the upper one, as in a window in memory, so that a
// software renderer copies it to the window as it is.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include "rendering/ui/viewport.h"

namespace palpate {

class Pixels {
 public:
  explicit Pixels(bool with_depth) : with_depth_(with_depth) {}
  Pixels(const Pixels&) = delete;
  Pixels& operator=(const Pixels&) = delete;
  ~Pixels() { release(); }

  // Makes it the target of drawing. The contents are kept unless the size changes; returns whether it has.
  bool draw_into(int width, int height);
  // Copies `from` to `to` of another one, or to `to` of the window (`other` null) with the origin at the lower left
  // corner of the window. Interpolates if the sizes differ. The target of drawing is undefined afterwards.
  void copy_to(const Pixels* other, const Viewport& from, const Viewport& to) const;
  unsigned colour() const noexcept { return colour_; }

 private:
  void make();
  void release();

  bool with_depth_;
  int width_ = 0, height_ = 0;
  unsigned framebuffer_ = 0, colour_ = 0, depth_ = 0;
};

}  // namespace palpate
