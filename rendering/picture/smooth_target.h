// A part of a picture drawn with several samples a pixel, so that edges are smooth:
// begun with what is there, put back over it in the end. Only the parts that
// something stands in, for every sample costs where the processor draws.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <span>

namespace palpate {

// In pixels of the framebuffer, from its lower left corner.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Viewport&) const = default;
};

class SmoothTarget {
 public:
  // Makes it the target of drawing: its lower left corner is that of `whole` in
  // `framebuffer` (0: the window). It has what is there in `parts`, all within `whole`, and
  // no depth yet; outside the parts it has nothing of use. False: the driver cannot, draw to
  // the framebuffer instead.
  bool begin(unsigned framebuffer, const Viewport& whole, std::span<const Viewport> parts);
  // Puts the parts back, and the framebuffer is what is drawn to again.
  void end(unsigned framebuffer, const Viewport& whole, std::span<const Viewport> parts) const;

  // For a picture that many frames begin with: keeps that of `framebuffer`, which goes to
  // `place` of the window, with all samples. Copying them is quicker than making them.
  void keep(unsigned framebuffer, const Viewport& place);
  // As `begin`, with what is kept instead; false when nothing is.
  bool begin_with_kept(const Viewport& whole, std::span<const Viewport> parts);

 private:
  struct Samples {
    Samples() = default;
    Samples(const Samples&) = delete;
    Samples& operator=(const Samples&) = delete;
    ~Samples() { release(); }
    // Bound in the end; false when the driver refuses.
    bool make(int width, int height, bool with_depth);
    void release();

    unsigned framebuffer = 0;
    unsigned buffers[2] = {0, 0};  // colour, depth
    int width = 0;
    int height = 0;
  };
  bool begin_from(unsigned framebuffer, int x, int y, const Viewport& whole, std::span<const Viewport> parts);

  Samples drawn_;
  Samples kept_;
  int kept_x_ = 0;
  int kept_y_ = 0;
  bool refused_ = false;
};

}  // namespace palpate
