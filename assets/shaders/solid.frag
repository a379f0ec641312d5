#version 330 core
// Smooth plastic, or a flat sign when shininess is 0.
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
  float wrapped = max((dot(n, light) + 0.3) / 1.3, 0.0);
  float shine = max(dot(n, normalize(light + to_eye)), 0.0);
  shine *= shine; shine *= shine; shine *= shine; shine *= shine;
  float rim = 1.0 - max(dot(n, to_eye), 0.0);
  pixel = vec4(colour * (0.42 + 0.60 * wrapped) + vec3(shininess * (0.45 * shine + 0.12 * rim * rim)), 1.0);
}
