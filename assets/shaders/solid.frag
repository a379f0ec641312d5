#version 330 core
// Polished or dull: what a surface shines with is the room in it, bright above and
// dark below, and the lamp. A flat sign when shininess is 0.
in vec3 world;
in vec3 surface_normal;

uniform vec3 eye;
uniform vec3 light;
uniform vec3 colour;
uniform float shininess;

out vec4 pixel;

void main() {
  vec3 n = normalize(surface_normal);
  vec3 to_eye = normalize(eye - world);
  float wrapped = max((dot(n, light) + 0.35) / 1.35, 0.0);
  vec3 mirrored = 2.0 * dot(n, to_eye) * n - to_eye;
  float lamp = max(dot(mirrored, light), 0.0);
  lamp *= lamp; lamp *= lamp; lamp *= lamp; lamp *= lamp;
  float room = smoothstep(-0.35, 0.75, mirrored.y);
  vec3 dull = colour * (0.40 + 0.20 * n.y + 0.50 * wrapped);
  vec3 polished = colour * (0.34 + 0.95 * room) + vec3(0.55 * lamp);
  pixel = vec4(mix(dull, polished, shininess), 1.0);
}
