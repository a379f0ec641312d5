// chai3d_program MODEL.json: presses a half space by the effect of assets/examples/chai3d, at 1 kHz, with two points of
// a tool. Returns 0 if the forces are those of a press.
#include <cstdio>
#include <thread>

#include "assets/examples/chai3d/palpate_effect.h"

int main(int, char** words) {
  chai3d::cGenericObject block;
  PalpateEffect effect(&block, palpate::Model(words[1]), 1.5e-3);
  auto due = std::chrono::steady_clock::now();
  double pressed_N = 0.0, tangential_N = 0.0, air_N = 0.0;
  for (int i = 0; i < 600; ++i) {
    for (const unsigned int point : {0U, 1U}) {
      const chai3d::cVector3d tool{1e-3 * i, 0.0, point == 0 ? 2e-3 - 1e-5 * i : 1e-3};
      block.m_interactionInside = tool.z < 0.0;
      block.m_interactionPoint = {tool.x, tool.y, 0.0};
      chai3d::cVector3d force;
      effect.computeForce(tool, {}, point, force);
      (point == 0 ? pressed_N : air_N) = force.z;
      tangential_N += std::abs(force.x) + std::abs(force.y);
    }
    std::this_thread::sleep_until(due += std::chrono::milliseconds(1));
  }
  std::printf("%.3f N pressed 4 mm, %.3f N in air, share %.2f\n", pressed_N, air_N, effect.stiffness_share());
  const bool fails = effect.computeForce({}, {}, 99, block.m_interactionPoint);
  return pressed_N > 0.0 && air_N == 0.0 && tangential_N == 0.0 && !fails ? 0 : 1;
}
