#include "models/model/file/json_arrays.h"

#include <nlohmann/json.hpp>

#include "engine/base/csv_scanner.h"

namespace palpate {

Eigen::VectorXd read_vector(JsonFields& fields, const JsonNode& object, const char* key, Eigen::Index size,
                            const std::string& words, const NumberRange& range) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(size);
  const JsonNode list = fields.member(object, key, "a list of numbers");
  fields.fill(list, static_cast<std::size_t>(size), words, values.data(), range);
  return values;
}

Eigen::MatrixXd read_points(JsonFields& fields, const JsonNode& object, const char* key, Eigen::Index dimension) {
  const std::string expected = "a list of at least one point";
  const JsonNode node = fields.list(object, key, expected);
  if (node.value == nullptr) return {};
  if (node.value->empty()) fields.complain(node.pointer, "found an empty list, expected " + expected);
  // The parsed list was in memory, so a matrix of as many points fits, too.
  Eigen::MatrixXd matrix(dimension, static_cast<Eigen::Index>(node.value->size()));
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    const JsonNode point = JsonFields::entry(node, static_cast<std::size_t>(j));
    if (!fields.fill(point, static_cast<std::size_t>(dimension), "numbers, one per feature", matrix.col(j).data()))
      break;
  }
  return matrix;
}

std::string json_number(double value) {
  std::string text = shortest(value);
  return text == "-0" ? "-0.0" : text;
}

std::string json_quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string json_joined(const char* open, const std::vector<std::string>& items, const char* between,
                        const char* close) {
  std::string text = open;
  for (std::size_t i = 0; i < items.size(); ++i) text.append(i == 0 ? "" : between).append(items[i]);
  return text.append(close);
}

std::string json_lines(const std::vector<std::string>& items) {
  return items.empty() ? "[]" : json_joined("[\n    ", items, ",\n    ", "\n  ]");
}

std::string json_columns(const Eigen::MatrixXd& matrix) {
  std::vector<std::string> items;
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) items.push_back(json_list(Eigen::VectorXd(matrix.col(j))));
  return json_lines(items);
}

}  // namespace palpate
