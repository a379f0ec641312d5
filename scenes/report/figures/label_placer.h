// Where the labels of a plot go: beside what they name, over no point, line or other
// label, as near as there is room.
//
//   From the wished place outward in rings, the first of kDirections where the text's
//   box is free; where nothing is, the wished place itself.
// Thread guarantee: one thread per object.
#pragma once

#include <string>
#include <vector>

namespace palpate {

// Pixels of the plot's area, from its lower left corner.
class LabelPlacer {
 public:
  struct Place {
    double x = 0.0;  // of the text's left end
    double y = 0.0;  // of its middle
    bool far = false;  // a line to what it names helps
  };

  LabelPlacer(double width, double height) : width_(width), height_(height) {}

  void keep_point_free(double x, double y);
  void keep_line_free(double x_0, double y_0, double x_1, double y_1);

  // Beside a point; the text's box is kept free of later ones.
  Place beside(double x, double y, const std::string& text);
  // Just above or below a level line, as far right as there is room.
  Place along(double y, const std::string& text);

 private:
  struct Box {
    double left, bottom, right, top;
  };

  static double width_of(const std::string& text);
  bool is_free(const Box& box) const;
  Place take(double x, double y, double width, bool far);

  double width_;
  double height_;
  std::vector<Box> taken_;
};

}  // namespace palpate
