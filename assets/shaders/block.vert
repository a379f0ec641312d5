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

uniform vec3 eye;
uniform vec3 light;       // towards it
uniform float tool_gap;   // metres between the tip and the surface; 0 in contact
uniform float height;     // metres, of the block

uniform vec3 colour;

out vec3 room_light;
out float lamp_light;
out float shadowed;
out float shine;
out vec2 fallen;
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
  float axis_distance = length(position.xz);
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
  vec3 world = place + offset;
  vec3 to_eye = normalize(eye - world);
  float up = clamp(place.y / height + 1.0, 0.0, 1.0);
  float facing = max(dot(n, to_eye), 0.0);
  float wrapped = max((dot(n, light) + 0.35) / 1.35, 0.0);
  // The block stands on something: the last millimetres get little light.
  float standing = 0.62 + 0.38 * smoothstep(0.0, 0.16, up);
  // The hollow's own walls keep light from its middle.
  float hollow = 1.0 - 0.45 * sunk * min(dent / tool_radius, 1.0);
  vec3 ambient = mix(vec3(0.30, 0.29, 0.28), vec3(0.45, 0.46, 0.47), 0.5 + 0.5 * n.y);
  // Light goes in and comes out again where the material is thin, its edges above all and
  // the wall of the dent, in its own colour: deeper than what the surface sends back.
  float thin = (1.0 - n.y) * smoothstep(0.2, 1.0, up) + 0.8 * sunk * (1.0 - sunk);
  float edge = (1.0 - facing) * (1.0 - facing);
  vec3 own = colour / max(max(colour.r, colour.g), colour.b);
  vec3 through = (0.22 * thin + 0.10 * (1.0 - facing) * (0.4 + 0.6 * up)) * own * own;
  room_light = (ambient + through) * standing * hollow;
  lamp_light = 0.60 * wrapped * mix(1.0, hollow, 0.5);
  // The tool's shadow falls away from the lamp, sharper and darker the nearer it is.
  fallen = (place.xz + tool_gap * light.xz / light.y) / (tool_radius * 0.95 + 0.8 * tool_gap);
  shadowed = n.y > 0.2 ? 0.52 / (1.0 + 70.0 * tool_gap) : 0.0;
  shine = max(dot(2.0 * dot(n, to_eye) * n - to_eye, light), 0.0);
  shine *= shine;
  shine *= shine;
  // The highlight slides over the dent; at grazing angles a smooth skin mirrors the room.
  shine = 0.13 * shine * shine + 0.16 * edge * edge * smoothstep(-0.1, 0.6, n.y);
  gl_Position = view_projection * vec4(world, 1.0);
}
