// How many pixels of the picture are drawn where the processor draws: fewer while frames are late.
// Thread guarantee: value type.
#pragma once

namespace palpate {

class Resolution {
 public:
  static constexpr float kLeast = 0.67F;  // of the pixels a side

  // What a frame took, without the wait for the next one to be due.
  void add(double busy_s) noexcept;
  float scale() const noexcept;

 private:
  int step_ = 0;  // below the full resolution
  int frames_ = 0;
  int good_ = 0;  // seconds in a row that leave room for more pixels
  double busy_s_ = 0.0;
};

}  // namespace palpate
