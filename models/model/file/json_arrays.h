// Numbers, vectors and points of a model file: read from untrusted JSON text, and written as the shortest decimals
// that read back as the same double, with one item a line so that models can be compared by lines.
// Thread guarantee: as JsonFields; what writes is pure, slow side (allocates).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "engine/json/json_fields.h"

namespace palpate {

// The member `key`: exactly `size` numbers of the range, which error messages call `words`. Otherwise an error in
// `fields`.
Eigen::VectorXd read_vector(JsonFields& fields, const JsonNode& object, const char* key, Eigen::Index size,
                            const std::string& words, const NumberRange& range = {});

// The member `key`: a list of at least one point, each a list of `dimension` numbers. Returns one column a point.
Eigen::MatrixXd read_points(JsonFields& fields, const JsonNode& object, const char* key, Eigen::Index dimension);

// The shortest decimal; "-0.0" for -0, because the JSON integer "-0" would lose the sign.
std::string json_number(double value);
std::string json_quoted(const std::string& text);
// "[1, 2.5]"
template <typename Values>
std::string json_list(const Values& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + json_number(value);
  return "[" + text + "]";
}
// `items` between brackets.
std::string json_joined(const char* open, const std::vector<std::string>& items, const char* between,
                        const char* close);
// A list of `items`, each on its own line.
std::string json_lines(const std::vector<std::string>& items);
// A list of the columns, each on its own line.
std::string json_columns(const Eigen::MatrixXd& matrix);

}  // namespace palpate
