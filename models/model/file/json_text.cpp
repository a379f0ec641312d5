#include "models/model/file/json_text.h"

#include <nlohmann/json.hpp>

#include "engine/base/csv_scanner.h"

namespace palpate {

std::string json_number(double value) {
  std::string text = shortest(value);
  return text == "-0" ? "-0.0" : text;
}

std::string json_quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_lines(const std::vector<std::string>& items) {
  std::string text = "[";
  for (std::size_t i = 0; i < items.size(); ++i) text += (i == 0 ? "\n    " : ",\n    ") + items[i];
  return text + (items.empty() ? "]" : "\n  ]");
}

std::string json_columns(const Eigen::MatrixXd& matrix) {
  std::vector<std::string> items;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) items.push_back(json_list(Eigen::VectorXd(matrix.col(j))));
  return json_lines(items);
}

}  // namespace palpate
