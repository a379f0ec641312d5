// The table is light in the middle and fades into the background. Every block has a soft shadow, computed from the
// distance to a rounded box.
in vec2 place;

uniform vec3 table_colour;
uniform vec3 background;
uniform float reach;       // radius at which the table has faded, metres
uniform vec2 half_size;    // of a block, metres
uniform int block_count;
uniform vec2 blocks[4];    // their positions, metres

out vec4 pixel;

float box_distance(vec2 p) {
  vec2 q = abs(p) - (half_size - 0.012);
  return length(max(q, 0.0)) + min(max(q.x, q.y), 0.0) - 0.012;
}

void main() {
  float fade = smoothstep(0.25 * reach, reach, length(place));
  vec3 colour = mix(table_colour, background, fade);
  float light = 1.0;
  for (int i = 0; i < block_count; ++i) {
    vec2 from = place - blocks[i];
    // A wide soft shadow away from the lamp, and a narrow dark one at the contact.
    float away = box_distance(from + vec2(-0.010, 0.013));
    float wide = smoothstep(-0.034, 0.052, away);
    float contact = smoothstep(-0.003, 0.012, box_distance(from));
    light *= (0.66 + 0.34 * wide) * (0.62 + 0.38 * contact);
  }
  colour *= light;
  pixel = vec4(colour, 1.0);
}
