#version 330 core
// A block of soft material with an analytic dent around the tool's tip.
//
// With d the dent's depth, R the tool's radius and r the distance from its axis:
//   r <= a:  u = d - R + sqrt(R^2 - r^2)       the surface lies on the ball
//   r >  a:  u = u_a b / (b + r - a)           and joins the flat with the same slope
// a = 0.92 R tanh(sqrt(d / R)), u_a = u(a), b = u_a sqrt(R^2 - a^2) / a. Towards
// the rim it fades out, so that the sides stand still.
layout(location = 0) in vec3 position;  // metres; the flat top at y = 0
layout(location = 1) in vec3 normal;

uniform mat4 view_projection;
uniform vec3 offset;
uniform float dent;         // metres
uniform float tool_radius;  // metres
uniform float rim;          // metres from the middle to the nearest side

out vec3 world;
out vec3 surface_normal;
out float axis_distance;
out float sunk;  // share of the dent's depth

float dent_at(float r) {
  if (dent <= 0.0) return 0.0;
  float a = 0.92 * tool_radius * tanh(sqrt(dent / tool_radius));
  float q = sqrt(tool_radius * tool_radius - a * a);
  float edge = dent - tool_radius + q;
  float b = max(edge * q / a, 1e-6);
  float x = min(r, a);
  float u = r <= a ? dent - tool_radius + sqrt(tool_radius * tool_radius - x * x) : edge * b / (b + r - a);
  return u * (1.0 - smoothstep(0.35 * rim, 0.9 * rim, r));
}

void main() {
  vec3 place = position;
  vec3 n = normal;
  axis_distance = length(position.xz);
  sunk = 0.0;
  if (position.y > -1e-5 && dent > 0.0) {
    const float h = 2e-4;
    float u = dent_at(axis_distance);
    float slope = (dent_at(axis_distance + h) - dent_at(max(axis_distance - h, 0.0))) /
                  (h + min(h, axis_distance));
    vec2 outward = axis_distance > 1e-6 ? position.xz / axis_distance : vec2(0.0);
    n = normalize(vec3(slope * outward.x, 1.0, slope * outward.y));
    place.y -= u;
    sunk = u / dent;
  }
  world = place + offset;
  surface_normal = n;
  gl_Position = view_projection * vec4(world, 1.0);
}
