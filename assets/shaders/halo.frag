// The glow around the ball while the error is above one JND, with a rim that can be seen from afar.
in vec2 at;

uniform vec3 colour;
uniform float opacity;
uniform float radius;      // of the rim, pixels
uniform float rim_width;   // pixels
uniform vec3 outline_colour;
uniform float outline_width;  // pixels

out vec4 pixel;  // multiplied with its opacity

void main() {
  float from = length(at);
  float glow = 0.55 * clamp(1.0 - from / radius, 0.0, 1.0) + 0.18 * clamp(radius - from + 0.5, 0.0, 1.0);
  float inside = 0.5 * rim_width - abs(from - radius);
  float cover = opacity * max(glow, clamp(inside + outline_width + 0.5, 0.0, 1.0));
  float outline = clamp(inside + outline_width + 0.5, 0.0, 1.0) * clamp(0.5 - inside, 0.0, 1.0);
  pixel = vec4(mix(colour, outline_colour, outline) * cover, cover);
}
