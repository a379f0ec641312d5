// A framebuffer object with colour and depth.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

namespace palpate {

// In pixels of a framebuffer; the origin is the lower left corner.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Viewport&) const = default;
};

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

}  // namespace palpate
