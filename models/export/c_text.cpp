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

void CText::rows(const std::string& declaration, const Eigen::MatrixXd& values, bool single) {
  const bool braces = declaration.find("][") != std::string::npos;  // two dimensions
  text_ += declaration + " = {\n";
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    text_ += braces ? "  {" : "  ";
    for (Eigen::Index i = 0; i < values.rows(); ++i) text_ += (i == 0 ? "" : ", ") + literal(values(i, j), single);
    text_ += braces ? "},\n" : ",\n";
  }
  text_ += "};\n";
  table_bytes_ += static_cast<std::size_t>(values.size()) * (single ? sizeof(float) : sizeof(double));
}

void CText::table(const std::string& name, const Eigen::MatrixXd& values, const std::string& type) {
  const std::string sizes = "[" + std::to_string(values.cols()) + "][" + std::to_string(values.rows()) + "]";
  rows("static const " + type + " " + name + sizes, values, single_ || type == "float");
}

}  // namespace palpate
