#include "rendering/picture/resolution.h"

#include <algorithm>
#include <iterator>

namespace palpate {
namespace {

constexpr float kScales[] = {1.0F, 0.82F, Resolution::kLeast};  // each has two thirds of the pixels of the one before
constexpr double kFrame_s = 1.0 / 60.0;
constexpr int kFrames = 60;                  // frames of a mean
constexpr double kStall_s = 2.0 * kFrame_s;  // longer frames count as this, so that one of them has no effect
constexpr double kLate = 0.97, kRoom = 0.90;
// A larger picture must fit for this many means, so that the resolution does not alternate.
constexpr int kGood = 5;

}  // namespace

bool is_software(std::string_view renderer) noexcept {
  // The software renderers of Mesa (three), Microsoft and Apple.
  for (const std::string_view program : {"llvmpipe", "softpipe", "SWR", "GDI Generic", "Software"}) {
    if (renderer.find(program) != std::string_view::npos) return true;
  }
  return false;
}

float Resolution::scale() const noexcept { return kScales[step_]; }

void Resolution::add(double busy_s) noexcept {
  busy_s_ += std::min(busy_s, kStall_s);
  if (++frames_ < kFrames) return;
  const double mean_s = busy_s_ / frames_;
  frames_ = 0;
  busy_s_ = 0.0;
  if (mean_s > kLate * kFrame_s) {
    step_ = std::min(step_ + 1, static_cast<int>(std::size(kScales)) - 1);
    good_ = 0;
    return;
  }
  if (step_ == 0) return;
  // The time of a larger picture, if all of it is proportional to the pixels.
  const float more = kScales[step_ - 1] / kScales[step_];
  good_ = mean_s * static_cast<double>(more * more) < kRoom * kFrame_s ? good_ + 1 : 0;
  if (good_ < kGood) return;
  --step_;
  good_ = 0;
}

}  // namespace palpate
