// C99 text of numbers and tables, in the precision of the exported file.
// Thread guarantee: one thread per object; slow side (allocates).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>

namespace palpate {

// Collects the text of the file and counts the bytes of its tables.
class CText {
 public:
  explicit CText(bool single_precision) : single_(single_precision) {}

  void add(std::string_view text) { text_ += text; }

  // The shortest decimal that reads back as the same number, as a literal of type `real`.
  std::string number(double value) const;
  // "static const TYPE NAME[ROWS][COLUMNS] = {...};": each column of `values` is one row of the table. `type`: real, or
  // float for single precision in any file.
  void table(const std::string& name, const Eigen::MatrixXd& values, const std::string& type = "real");
  // "static const real NAME[SIZE] = {...};" `values`: a vector or an array of doubles.
  void list(const std::string& name, const auto& values) {
    const auto size = static_cast<Eigen::Index>(values.size());
    rows("static const real " + name + "[" + std::to_string(size) + "]",
         Eigen::Map<const Eigen::RowVectorXd>(values.data(), size), single_);
  }

  bool single() const { return single_; }
  const std::string& text() const { return text_; }
  std::size_t table_bytes() const { return table_bytes_; }

 private:
  void rows(const std::string& declaration, const Eigen::MatrixXd& values, bool single);

  bool single_;
  std::string text_;
  std::size_t table_bytes_ = 0;
};

}  // namespace palpate
