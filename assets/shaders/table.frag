// The table is light under the block and fades into the background. The block has a soft shadow, computed from the
// distance to a rounded box.
in vec2 place;

uniform vec3 table_colour;
uniform vec3 background;
uniform float reach;     // radius at which the table has faded, metres
uniform vec2 half_size;  // of the whole block, whose rear half is there, metres

out vec4 pixel;

float box_distance(vec2 p) {
  vec2 q = abs(p) - (vec2(1.0, 0.5) * half_size - 0.006);
  return length(max(q, 0.0)) + min(max(q.x, q.y), 0.0) - 0.006;
}

void main() {
  vec2 from = place + vec2(0.0, 0.5 * half_size.y);
  float fade = smoothstep(0.45, 1.0, length(place * vec2(1.0, 1.0 + 1.3 * step(0.0, place.y))) / reach);
  float wide = smoothstep(-0.030, 0.030, box_distance(from + vec2(-0.006, 0.008)));
  float contact = smoothstep(-0.003, 0.010, box_distance(from));
  float light_left = (0.62 + 0.38 * wide) * (0.62 + 0.38 * contact);
  pixel = vec4(mix(table_colour * light_left, background, fade), 1.0);
}
