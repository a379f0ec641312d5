// The resolution of the 3-D view with a software renderer.
// Thread guarantee: values of the window's thread.
#pragma once

#include <string_view>

namespace palpate {

// Whether OpenGL is a program instead of a graphics card. `renderer`: its name as OpenGL reports it.
bool is_software(std::string_view renderer) noexcept;

// Selects the resolution: it is lower while frames are late.
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
