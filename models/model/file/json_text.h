// JSON text of a model file: numbers as the shortest decimals that read back as the
// same double, arrays one item to a line where models are to be compared by lines.
// Thread guarantee: pure functions, slow side (allocate).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace palpate {

// The shortest decimal, but never "-0": as a JSON integer it would lose its sign.
std::string json_number(double value);
std::string json_quoted(const std::string& text);
// "[1, 2.5]"
template <typename Values>
std::string json_list(const Values& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + json_number(value);
  return "[" + text + "]";
}
// A list of `items`, each on its own line.
std::string json_lines(const std::vector<std::string>& items);
// A list of the columns, each on its own line.
std::string json_columns(const Eigen::MatrixXd& matrix);

}  // namespace palpate
