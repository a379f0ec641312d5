#include "scenes/report/figures/label_placer.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// Of the page's 15 pixel font.
constexpr double kLetterWidth = 8.6;
constexpr double kLetterHeight = 17.0;
constexpr double kPointRadius = 5.0;
constexpr double kLineStep = 6.0;
constexpr double kBeside = 9.0;   // from a point to its label
constexpr double kBetween = 12.0;  // from one text to the next: letters are of many widths
constexpr double kRing = 8.0;
constexpr int kRings = 24;
constexpr int kDirections = 16;
constexpr double kFar = 18.0;

}  // namespace

double LabelPlacer::width_of(const std::string& text) {
  // A letter of several bytes has one that begins it.
  const auto letters = std::count_if(text.begin(), text.end(), [](char byte) { return (byte & 0xC0) != 0x80; });
  return kLetterWidth * static_cast<double>(letters);
}

bool LabelPlacer::is_free(const Box& box) const {
  if (box.left < 0.0 || box.bottom < 0.0 || box.right > width_ || box.top > height_) return false;
  return std::none_of(taken_.begin(), taken_.end(), [&](const Box& one) {
    return box.left < one.right && one.left < box.right && box.bottom < one.top && one.bottom < box.top;
  });
}

LabelPlacer::Place LabelPlacer::take(double x, double y, double width, bool far) {
  taken_.push_back({x - kBetween, y - 0.5 * kLetterHeight, x + width + kBetween, y + 0.5 * kLetterHeight});
  return {x, y, far};
}

void LabelPlacer::keep_point_free(double x, double y) {
  taken_.push_back({x - kPointRadius, y - kPointRadius, x + kPointRadius, y + kPointRadius});
}

void LabelPlacer::keep_line_free(double x_0, double y_0, double x_1, double y_1) {
  const int steps = 1 + static_cast<int>(std::hypot(x_1 - x_0, y_1 - y_0) / kLineStep);
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    const double x = x_0 + share * (x_1 - x_0);
    const double y = y_0 + share * (y_1 - y_0);
    taken_.push_back({x - 1.0, y - 1.0, x + 1.0, y + 1.0});
  }
}

LabelPlacer::Place LabelPlacer::beside(double x, double y, const std::string& text) {
  const double width = width_of(text);
  for (int ring = 0; ring < kRings; ++ring) {
    for (int direction = 0; direction < (ring == 0 ? 1 : kDirections); ++direction) {
      // Right first, then up and down in turn.
      const double turn = (direction % 2 == 0 ? 1.0 : -1.0) * ((direction + 1) / 2) * 2.0 * 3.14159265358979 / kDirections;
      const double across = std::cos(turn);
      const double left = x + kBeside + ring * kRing * across - (across < -0.3 ? width + 2.0 * kBeside : 0.0);
      const double middle = y + ring * kRing * std::sin(turn);
      if (is_free({left, middle - 0.5 * kLetterHeight, left + width, middle + 0.5 * kLetterHeight})) {
        return take(left, middle, width, ring * kRing > kFar);
      }
    }
  }
  return take(x + kBeside, y, width, false);
}

LabelPlacer::Place LabelPlacer::along(double y, const std::string& text) {
  const double width = width_of(text);
  const double away = 0.5 * kLetterHeight + 3.0;
  for (double left = width_ - width - 4.0; left >= 0.0; left -= kRing) {
    for (const double middle : {y + away, y - away}) {
      if (is_free({left, middle - 0.5 * kLetterHeight, left + width, middle + 0.5 * kLetterHeight})) {
        return take(left, middle, width, false);
      }
    }
  }
  return take(4.0, y + away, width, false);
}

}  // namespace palpate
