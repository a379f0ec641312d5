#include "models/export/c_text.h"

#include <array>
#include <charconv>

namespace palpate {
namespace {

template <typename Real>
std::string shortest(Real value) {
  std::array<char, 40> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  std::string text(buffer.data(), end.ptr);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

// A value too small for a float becomes 0, because a literal that underflows is an error of the compiler.
std::string literal(double value, bool single) {
  return single ? shortest(static_cast<float>(value)) + "F" : shortest(value);
}

}  // namespace

std::string CText::number(double value) const { return literal(value, single_); }

void CText::table(const std::string& name, const Eigen::MatrixXd& values, const std::string& type) {
  const bool single = single_ || type == "float";
  const bool braces = name.find("][") != std::string::npos;
  add("static const " + type + " " + name + " = {\n");
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    add(braces ? "  {" : "  ");
    for (Eigen::Index i = 0; i < values.rows(); ++i) add((i == 0 ? "" : ", ") + literal(values(i, j), single));
    add(braces ? "},\n" : ",\n");
  }
  add("};\n");
}

}  // namespace palpate
