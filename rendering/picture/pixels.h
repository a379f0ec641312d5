// What is drawn into before it comes to the window: colour and depth of a picture.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

namespace palpate {

class Pixels {
 public:
  // `samples`: of every pixel; 0: the pixel itself, and its colour is a texture.
  explicit Pixels(int samples) : samples_(samples) {}
  Pixels(const Pixels&) = delete;
  Pixels& operator=(const Pixels&) = delete;
  ~Pixels() { release(); }

  // Draws into them from here on; what was in them is kept as long as their size is.
  // False: the driver refuses, and nothing has changed.
  bool draw_into(int width, int height);
  // All of them, sized to all of `other`'s.
  void copy_to(const Pixels& other) const;
  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  unsigned framebuffer() const noexcept { return framebuffer_; }
  unsigned colour() const noexcept { return colour_; }

 private:
  bool make();
  void release();

  int samples_, width_ = 0, height_ = 0;
  unsigned framebuffer_ = 0, colour_ = 0, depth_ = 0;
};

}  // namespace palpate
