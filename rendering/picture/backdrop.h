// A picture that is drawn once and copied every frame until it changes: what stands
// still while the camera does, the panel between two of its frames. Where pixels are
// computed by the processor this is a third of the work of a frame.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

namespace palpate {

class Backdrop {
 public:
  Backdrop() = default;
  Backdrop(const Backdrop&) = delete;
  Backdrop& operator=(const Backdrop&) = delete;
  ~Backdrop();

  // Makes it the target of drawing, `width` x `height` pixels; `end` goes back to
  // the window. False: the driver cannot, draw to the window instead.
  bool begin(int width, int height);
  void end();
  // The window's `width` x `height` pixels from (x, y), lower left corner, on.
  void take(int x, int y, int width, int height);
  unsigned framebuffer() const noexcept { return framebuffer_; }
  // Onto the window at (x, y), lower left corner.
  void copy(int x, int y) const;

 private:
  unsigned framebuffer_ = 0;
  unsigned texture_ = 0;
  int width_ = 0;
  int height_ = 0;
};

}  // namespace palpate
