// A camera that orbits a point above the table, with limits, and eases to where
// it is asked to go.
// Thread guarantee: value type.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace palpate {

// How a person has turned a camera away from where it was put: what outlives a change
// of what is framed.
struct CameraTurn {
  float yaw_rad = 0.0F;
  float pitch_rad = 0.0F;
  float distance = 1.0F;  // factor
  bool operator==(const CameraTurn&) const = default;
};

class Camera {
 public:
  // To see blocks that together reach `radius_m` from the middle, from so far to
  // the right of the front. `at_once`: without easing.
  void frame(float radius_m, float yaw_rad, bool at_once);
  void orbit(float yaw_rad, float pitch_rad);
  // Factor on the distance: below 1 nearer.
  void zoom(float factor);
  // Back to where it was put.
  void go_home() { turn({}); }
  CameraTurn turned() const noexcept { return turn_; }
  void turn(const CameraTurn& turn);
  // Eases, over about 0.2 s.
  void advance(float seconds);

  glm::vec3 eye() const;
  glm::mat4 view_projection(float aspect) const;

 private:
  static constexpr float kFieldOfView_rad = 0.55F;
  struct Pose {
    float yaw_rad = 0.5F;
    float pitch_rad = 0.42F;
    float distance_m = 0.4F;
    bool operator==(const Pose&) const = default;
  };
  void aim();  // at `framed_`, turned
  Pose now_;
  Pose target_;
  Pose framed_;  // as put
  CameraTurn turn_;
  float radius_m_ = 0.1F;
};

// Where `world` is in a viewport of `size` pixels, y down; behind the eye: far
// outside.
glm::vec2 project(const glm::mat4& view_projection, const glm::vec3& world, const glm::vec2& size);

}  // namespace palpate
