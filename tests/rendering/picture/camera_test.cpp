#include "rendering/picture/block_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace palpate {
namespace {

TEST(Camera, SeesWhatItFrames) {
  Camera camera;
  camera.frame(0.1F, 0.0F, 0.2F, 0.3F, true);
  const glm::vec2 size(768.0F, 720.0F);
  const glm::mat4 view = camera.view_projection(size.x / size.y);
  for (const glm::vec3 point :
       {glm::vec3(0.09F, 0.0F, 0.0F), glm::vec3(-0.09F, 0.0F, 0.0F), glm::vec3(0.0F, 0.0F, 0.09F)}) {
    const glm::vec2 at = project(view, point, size);
    EXPECT_GT(at.x, 0.0F);
    EXPECT_LT(at.x, size.x);
    EXPECT_GT(at.y, 0.0F);
    EXPECT_LT(at.y, size.y);
  }
  EXPECT_LT(project(view, {0.0F, 0.05F, 0.0F}, size).y, project(view, {0.0F, 0.0F, 0.0F}, size).y) << "up is up";
}

// The blocks are cut open at the front.
TEST(Camera, StaysAboveTheTableBeforeTheCutAndWithinItsDistances) {
  Camera camera;
  camera.frame(0.1F, 0.0F, 0.2F, 0.3F, true);
  for (const auto& [pitch_rad, factor] : {std::pair{-50.0F, 1e-3F}, std::pair{50.0F, 1e3F}}) {
    camera.orbit(pitch_rad, pitch_rad);
    camera.zoom(factor);
    for (int i = 0; i < 300; ++i) camera.advance(0.016F);
    const glm::vec3 eye = camera.eye();
    EXPECT_GT(eye.y, 0.0F);
    EXPECT_GT(eye.z, std::abs(eye.x));
    EXPECT_GT(std::hypot(eye.x, eye.z), 0.1F * eye.y) << "left stays left";
    EXPECT_GE(glm::length(eye), 0.15F);
    EXPECT_LE(glm::length(eye), 1.21F);
  }
}

}  // namespace
}  // namespace palpate
