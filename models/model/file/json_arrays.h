// Vectors and points from an untrusted JSON text, for readers of parts of a model.
// Thread guarantee: as JsonFields.
#pragma once

#include <Eigen/Core>
#include <string>

#include "engine/json/json_fields.h"

namespace palpate {

// The member `key`: exactly `size` numbers (`words` says which). Zeros, and a
// complaint, when it is anything else.
Eigen::VectorXd read_vector(JsonFields& fields, const JsonNode& object, const char* key, Eigen::Index size,
                            const std::string& words);

// The member `key`: a list of at least one point, each a list of `dimension` numbers;
// one point a column.
Eigen::MatrixXd read_points(JsonFields& fields, const JsonNode& object, const char* key, Eigen::Index dimension);

}  // namespace palpate
