#include "engine/tick/normal_tail.h"

#include <cmath>

namespace palpate::normal_table {
namespace {

std::array<NormalTail, kNodes> filled() {
  constexpr double kInverseSqrt2Pi = 0.3989422804014327;
  constexpr double kInverseSqrt2 = 0.7071067811865476;
  std::array<NormalTail, kNodes> table;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double x = static_cast<double>(i) / kPerUnit;
    table[i] = {0.5 * std::erfc(x * kInverseSqrt2), kInverseSqrt2Pi * std::exp(-0.5 * x * x)};
  }
  return table;
}

}  // namespace

const std::array<NormalTail, kNodes> nodes = filled();

}  // namespace palpate::normal_table
