// The cut face. Light enters from above and is lost with the depth; layers of the material bend under the ball. While the
// ball presses, the colour of the error spreads from it, with an outline.
noperspective in vec3 material;
flat in vec3 lit;

uniform vec3 colour;
uniform vec3 half_size;     // of the whole block, y its whole height, metres
uniform vec3 mark_colour;   // of the error
uniform float mark;         // its opacity, 0..1
uniform float mark_radius;  // how far it has spread, metres
uniform float translucent;  // 0..1
uniform float pores;        // 0..1
uniform float grid;         // opacity of its lines, 0..1
uniform vec3 outline_colour;
uniform float outline_width;  // pixels
uniform float px_per_m;

out vec4 pixel;

void main() {
  float deep = -material.y;
  float below = 0.016 / (0.016 + deep);
  below *= below;
  // The bright edge, where light passes a thin part.
  float from_edge = max(min(deep, half_size.x - abs(material.x)), 0.0);
  float thin = 0.004 / (0.004 + from_edge);
  vec3 base = colour * (0.78 + 0.26 * below);
  float foot = min(1.0, 0.62 + 9.0 * (1.0 + material.y / half_size.y));  // the table occludes it
  // Distance from the border of what is coloured, pixels; negative inside.
  float away = length(vec2(material.x, material.z + dent - tool_radius)) - mark_radius;
  // It ends before the edges of the face, with rounded corners.
  const float kRound = 0.012;
  vec2 beyond = max(vec2(abs(material.x) - 0.86 * rim, deep - 0.92 * half_size.y) + kRound, 0.0);
  away = max(away, length(beyond) - kRound) * px_per_m;
  float spread = clamp(0.5 - away, 0.0, 1.0);
  base = mix(base, mark_colour * (0.90 + 0.16 * below), mark * spread);
  base *= 1.0 - grid * max(1.6 * line_of_grid(material.y, 0.005, px_per_m), line_of_grid(material.x, 0.01, px_per_m));
#ifdef PORES
  base *= 1.0 - pores * pits(vec3(material.xy, 0.0), vec3(0.0, 0.0, 1.0), 2.0 / px_per_m);
#endif
  vec3 shine = colour * (0.20 + 0.35 * translucent) * thin * thin * (1.0 - 0.8 * mark * spread);
  float ring = mark * clamp(outline_width + 0.5 - abs(away + outline_width), 0.0, 1.0);
  pixel = vec4(mix(base * lit * foot + shine, outline_colour, ring), 1.0);
}
