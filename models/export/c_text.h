// C99 text of numbers and tables, in the precision of the exported file.
// Thread guarantee: one thread per object; slow side (allocates).
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

namespace palpate {

class CText {
 public:
  explicit CText(bool single_precision) : single_(single_precision) {}

  bool single() const { return single_; }
  const std::string& text() const { return text_; }

  // The shortest decimal that reads back as the same number, as a literal of type `real`.
  std::string number(double value) const;

  void add(std::string_view text) { text_ += text; }
  // "#define NAME VALUE".
  void define(const std::string& name, const std::string& value) { add("#define " + name + " " + value + "\n"); }
  void define(const std::string& name, double value) { define(name, number(value)); }
  void define(const std::string& name, std::size_t value) { define(name, std::to_string(value)); }
  // "static const TYPE NAME[] = {...};" of all values, or for a NAME of two dimensions, such as "centres[][3]", with
  // each column of `values` as one row of the table. `type`: real, or float for single precision in any file.
  void table(const std::string& name, const Eigen::MatrixXd& values, const std::string& type = "real");
  // The same for a vector or an array of doubles.
  void list(const std::string& name, const auto& values) {
    table(name + "[]", Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  }

 private:
  bool single_;
  std::string text_;
};

}  // namespace palpate
