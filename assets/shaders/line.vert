// The profile of the surface in the cut face as a line of constant width in pixels.
layout(location = 0) in vec3 position;  // x: metres; y: -1 or 1, the side of the line

uniform vec2 cell;     // size of the picture of a block, pixels
uniform float width;   // of the line with its rim, pixels

out float across;  // pixels from the middle of the line

void main() {
  Surface surface = surface_at(abs(position.x));
  vec3 at = vec3(position.x, -surface.depth, 0.0);
  vec3 ahead = at + 1e-3 * vec3(1.0, -surface.slope * sign(position.x), 0.0);
  vec4 here = view_projection * vec4(at, 1.0);
  vec4 there = view_projection * vec4(ahead, 1.0);
  vec2 along = normalize((there.xy / there.w - here.xy / here.w) * cell);
  across = position.y * (0.5 * width + 1.0);
  here.xy += 2.0 * across * vec2(-along.y, along.x) / cell * here.w;
  gl_Position = here;
}
