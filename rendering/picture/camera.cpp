#include "rendering/picture/block_view.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/vector_relational.hpp>

namespace palpate {
namespace {

// The camera is never below the table, and stays before the front of the blocks, where they are cut open.
constexpr float kLowest_rad = 0.06F;
constexpr float kHighest_rad = 0.95F;
constexpr float kWidest_rad = 0.7F;
constexpr float kEasing_s = 0.12F;
constexpr float kNear_m = 0.02F;
constexpr float kFar_m = 6.0F;

}  // namespace

void Camera::frame(float radius_m, float height_m, float yaw_rad, float pitch_rad, bool at_once) {
  radius_m_ = radius_m;
  framed_ = {yaw_rad, pitch_rad, radius_m / std::tan(0.5F * kFieldOfView_rad), height_m};
  aim();
  if (at_once) now_ = target_;
}

void Camera::turn(const CameraTurn& turn) {
  turn_ = turn;
  aim();
}

// Limits the turn as well, so that a turn back has an effect at once.
void Camera::aim() {
  target_ = {std::clamp(framed_[0] + turn_.yaw_rad, -kWidest_rad, kWidest_rad),
             std::clamp(framed_[1] + turn_.pitch_rad, kLowest_rad, kHighest_rad),
             std::clamp(framed_[2] * turn_.distance, 1.6F * radius_m_, 12.0F * radius_m_), framed_[3]};
  turn_ = {target_[0] - framed_[0], target_[1] - framed_[1], target_[2] / framed_[2]};
}

void Camera::orbit(float yaw_rad, float pitch_rad) {
  turn({turn_.yaw_rad + yaw_rad, turn_.pitch_rad + pitch_rad, turn_.distance});
}

void Camera::zoom(float factor) { turn({turn_.yaw_rad, turn_.pitch_rad, turn_.distance * factor}); }

void Camera::advance(float seconds) {
  // Less than a tenth of a pixel in a picture of 1080 lines; the parts at rest are drawn until it ends.
  constexpr float kEnd = 1e-4F;
  now_ += (1.0F - std::exp(-std::max(0.0F, seconds) / kEasing_s)) * (target_ - now_);
  const glm::vec4 near = kEnd * glm::vec4(1.0F, 1.0F, target_[2], target_[2]);
  if (glm::all(glm::lessThan(glm::abs(target_ - now_), near))) now_ = target_;
}

glm::vec3 Camera::eye() const {
  const float flat_m = now_[2] * std::cos(now_[1]);
  return {flat_m * std::sin(now_[0]), now_[3] + now_[2] * std::sin(now_[1]), flat_m * std::cos(now_[0])};
}

glm::mat4 Camera::view_projection(float aspect) const {
  // In a tall viewport the field of view is that of the width.
  const float vertical =
      aspect >= 1.0F ? kFieldOfView_rad : 2.0F * std::atan(std::tan(0.5F * kFieldOfView_rad) / aspect);
  return glm::perspective(vertical, aspect, kNear_m, kFar_m) *
         glm::lookAt(eye(), glm::vec3(0.0F, now_[3], 0.0F), glm::vec3(0.0F, 1.0F, 0.0F));
}

glm::vec2 project(const glm::mat4& view_projection, const glm::vec3& world, const glm::vec2& size) {
  const glm::vec4 clip = view_projection * glm::vec4(world, 1.0F);
  if (clip.w <= 0.0F) return {-1e6F, -1e6F};
  return {(0.5F + 0.5F * clip.x / clip.w) * size.x, (0.5F - 0.5F * clip.y / clip.w) * size.y};
}

}  // namespace palpate
