#include "scenes/material/button_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate {
namespace {

// Forces at every 10 um of a stroke to 6 mm and back.
struct Stroke {
  std::vector<double> in_N, out_N;
};

Stroke stroke(double speed_m_per_s) {
  constexpr int kSteps = 600;
  constexpr double kStep_m = 1e-5;
  ButtonBlock block;
  block.reset(0.0);
  const double dt_s = kStep_m / speed_m_per_s;
  Stroke result;
  for (int i = 1; i <= kSteps; ++i) result.in_N.push_back(block.step(i * kStep_m, speed_m_per_s, dt_s));
  for (int i = kSteps; i > 0; --i) result.out_N.push_back(block.step((i - 1) * kStep_m, -speed_m_per_s, dt_s));
  std::reverse(result.out_N.begin(), result.out_N.end());
  return result;
}

TEST(ButtonBlock, FallsBehindAPeakAndMeetsAFloor) {
  const Stroke slow = stroke(0.002);
  const auto peak = std::max_element(slow.in_N.begin(), slow.in_N.begin() + 250);
  const auto valley = std::min_element(peak, slow.in_N.end());
  EXPECT_NEAR(1e-5 * static_cast<double>(peak - slow.in_N.begin()), 1.4e-3, 0.4e-3);
  EXPECT_GT(*peak, 1.5 * *valley) << "a click";
  EXPECT_GT(*valley, 0.0) << "it comes back by itself";
  EXPECT_GT(slow.in_N.back(), 2.0 * *peak);
}

TEST(ButtonBlock, ComesBackAnotherWay) {
  const Stroke slow = stroke(0.002);
  double in_J = 0.0;
  double out_J = 0.0;
  for (std::size_t i = 0; i < slow.out_N.size(); ++i) {
    // Compares at the same depth: the way in starts one step inside the block.
    const double in_N = i > 0 ? slow.in_N[i - 1] : 0.0;
    EXPECT_LE(slow.out_N[i], in_N + 1e-9) << i;
    in_J += 1e-5 * slow.in_N[i];
    out_J += 1e-5 * slow.out_N[i];
  }
  EXPECT_LT(out_J, 0.95 * in_J);
  EXPECT_GT(out_J, 0.3 * in_J);
}

// The truss in equilibrium: when the dome is flat, the forces of the legs cancel and only that
// of the skirt is left.
TEST(ButtonBlock, OnlyTheSkirtResistsAfterTheSnap) {
  const Stroke slow = stroke(0.0005);
  const auto flat = static_cast<std::size_t>(std::lround(ButtonBlock::kRise_m / 1e-5)) - 1;
  EXPECT_NEAR(slow.in_N[flat],
              ButtonBlock::kSkirt_N_per_m * ButtonBlock::kRise_m + ButtonBlock::kSkirt_Ns_per_m * 0.0005, 1e-6);
}

}  // namespace
}  // namespace palpate
