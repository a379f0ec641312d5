// A polished or dull surface; polished ones reflect the room and the lamp.
in vec3 world;
in vec3 surface_normal;

uniform vec3 colour;
uniform float shininess;

out vec4 pixel;

void main() {
  vec3 n = normalize(surface_normal);
  vec3 to_eye = normalize(eye - world);
  vec3 mirrored = 2.0 * dot(n, to_eye) * n - to_eye;
  float edge = 1.0 - max(dot(n, to_eye), 0.0);
  vec3 dull = colour * (0.40 + 0.20 * n.y + 0.50 * wrapped(n, vec3(0.35))) + vec3(0.12 * edge * edge * shininess);
  vec3 polished = colour * (0.34 + 0.95 * mirrored_room(mirrored)) + vec3(0.55 * mirrored_lamp(mirrored, 16.0));
  pixel = vec4(mix(dull, polished, shininess), 1.0);
}
