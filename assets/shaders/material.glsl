// Patterns of a soft material.
const float kLineWidth = 0.0006;  // of the grid, metres

// Coverage of this pixel by lines of the grid at a distance of `step` metres.
float line_of_grid(float at, float step, float px_per_m) {
  float away = abs(fract(at / step + 0.5) - 0.5) * step;
  return clamp((0.5 * kLineWidth - away) * px_per_m + 0.5, 0.0, 1.0) * min(1.0, kLineWidth * px_per_m);
}

#ifdef PORES
float random(vec2 cell) { return fract(sin(dot(cell, vec2(12.9898, 78.233))) * 43758.5453); }

// Coverage by small pits, on all sides. `pixel_m`: size of a pixel there, metres.
float pits(vec3 at, vec3 side, float pixel_m) {
  vec2 place = (side.y > 0.5 ? at.xz : side.x > 0.5 ? at.zy : at.xy) / 0.0016;
  vec2 cell = floor(place);
  vec2 middle = vec2(random(cell), random(cell + 7.3)) * 0.5 + 0.25;
  float size = 0.12 + 0.26 * random(cell + 3.1);
  float pixel_size = pixel_m / 0.0016;
  return (1.0 - smoothstep(size - pixel_size, size + pixel_size, length(place - cell - middle))) /
         (1.0 + 1.5 * pixel_size);
}
#endif
