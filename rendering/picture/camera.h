// A camera that orbits a point above the table within limits and moves smoothly to its target.
// Thread guarantee: value type.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace palpate {

// The user's rotation and zoom relative to the basic view. They are kept when the basic view changes.
struct CameraTurn {
  float yaw_rad = 0.0F;
  float pitch_rad = 0.0F;
  float distance = 1.0F;  // factor
  bool operator==(const CameraTurn&) const = default;
};

class Camera {
 public:
  static constexpr float kFieldOfView_rad = 0.55F;  // of the smaller side of the picture

  // Sets the basic view: what is within `radius_m` of the point at `height_m` above the middle fills the picture, seen
  // from `yaw_rad` to the right of the front and `pitch_rad` above it. `at_once`: without a transition.
  void frame(float radius_m, float height_m, float yaw_rad, float pitch_rad, bool at_once);
  void orbit(float yaw_rad, float pitch_rad);
  // Multiplies the distance by `factor`.
  void zoom(float factor);
  // Returns to the basic view.
  void go_home() { turn({}); }
  CameraTurn turned() const noexcept { return turn_; }
  void turn(const CameraTurn& turn);
  // Moves towards the target, with a time constant of 0.12 s.
  void advance(float seconds);

  glm::vec3 eye() const;
  glm::mat4 view_projection(float aspect) const;

 private:
  struct Pose {
    float yaw_rad = 0.0F;
    float pitch_rad = 0.3F;
    float distance_m = 0.4F;
    float height_m = 0.0F;
  };
  void aim();  // computes `target_` from `framed_` and `turn_`
  Pose now_;
  Pose target_;
  Pose framed_;
  CameraTurn turn_;
  float radius_m_ = 0.1F;
};

// The position of `world` in a viewport of `size` pixels, y down; far outside when it is behind the camera.
glm::vec2 project(const glm::mat4& view_projection, const glm::vec3& world, const glm::vec2& size);

}  // namespace palpate
