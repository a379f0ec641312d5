// Precedes every shader of this folder that draws bodies.
uniform mat4 view_projection;
uniform vec3 eye;    // position of the camera
uniform vec3 light;  // towards the lamp, length 1

// Brightness of the room that a smooth surface reflects: bright above, dark below.
float mirrored_room(vec3 direction) { return smoothstep(-0.35, 0.75, direction.y); }
// The 32nd power, as products, because a software renderer computes a power with a logarithm.
float mirrored_lamp(vec3 direction) {
  float x = max(dot(direction, light), 0.0);
  x *= x;
  x *= x;
  x *= x;
  x *= x;
  return x * x;
}
// Diffuse light of a translucent body. `wrap`, 0..1: how far light reaches beyond the terminator.
vec3 wrapped(vec3 n, vec3 wrap) { return max((dot(n, light) + wrap) / (1.0 + wrap), 0.0); }
