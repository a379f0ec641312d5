#include "models/model/rbf/rbf_function.h"

#include <string>

#include "engine/tick/features.h"
#include "models/model/rbf/polynomial_tail.h"

namespace palpate {

Status validate_rbf_function(const RbfFunction& function) {
  const int dimension = function.dimension();
  if (dimension < 1 || dimension > static_cast<int>(kMaxFeatures))
    return Error{"centres have " + std::to_string(dimension) + " coordinates, expected 1 to " +
                 std::to_string(kMaxFeatures)};
  if (function.weights.size() != function.centre_count())
    return Error{"there are " + std::to_string(function.weights.size()) + " weights, expected " +
                 std::to_string(function.centre_count()) + ", one per centre"};
  const int expected = tail_size(tail_degree(function.kernel), dimension);
  if (function.tail.size() != expected)
    return Error{"the polynomial tail has " + std::to_string(function.tail.size()) + " coefficients, expected " +
                 std::to_string(expected)};
  if (!function.centres.allFinite() || !function.weights.allFinite() || !function.tail.allFinite())
    return Error{"centres, weights and tail must be finite numbers"};
  return {};
}

}  // namespace palpate
