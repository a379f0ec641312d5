in float across;

uniform vec3 colour;
uniform vec3 outline_colour;
uniform float width;          // of the line with its rim, pixels
uniform float outline_width;  // of its rim, pixels

out vec4 pixel;  // multiplied with its opacity

void main() {
  float inside = 0.5 * width - abs(across);
  float cover = clamp(inside + 0.5, 0.0, 1.0);
  pixel = vec4(mix(outline_colour, colour, clamp(inside - outline_width + 0.5, 0.0, 1.0)) * cover, cover);
}
