// Second pass of the edge filter: fast approximate anti-aliasing (Lottes 2009). An edge is where the brightness of
// neighbours differs. The shader follows the edge to both ends of its step. It then samples the picture across the edge,
// at the distance that corresponds to the coverage of this pixel. Only the pixels that find_edges.frag has marked are
// drawn, by the depth test; a branch would save nothing with a software renderer. The result is upside down.
uniform sampler2D picture;
uniform int steps;  // along an edge in each direction; the compiler would unroll a constant number

out vec4 pixel;

void main() {
  vec2 whole = vec2(textureSize(picture, 0));
  vec2 at = gl_FragCoord.xy / whole;
  at.y = 1.0 - at.y;
  float here = textureLod(picture, at, 0.0).g;
  float up = textureLodOffset(picture, at, 0.0, ivec2(0, 1)).g;
  float down = textureLodOffset(picture, at, 0.0, ivec2(0, -1)).g;
  float left = textureLodOffset(picture, at, 0.0, ivec2(-1, 0)).g;
  float right = textureLodOffset(picture, at, 0.0, ivec2(1, 0)).g;
  float high = max(here, max(max(up, down), max(left, right)));
  float low = min(here, min(min(up, down), min(left, right)));

  vec2 one = 1.0 / whole;
  bool lies = abs(up + down - 2.0 * here) >= abs(left + right - 2.0 * here);
  vec2 along = lies ? vec2(one.x, 0.0) : vec2(0.0, one.y);
  vec2 across = lies ? vec2(0.0, one.y) : vec2(one.x, 0.0);
  float before = lies ? down : left;
  float after = lies ? up : right;
  float side = abs(after - here) >= abs(before - here) ? 1.0 : -1.0;
  float other = side > 0.0 ? after : before;
  float middle = 0.5 * (here + other);
  float slack = 0.25 * abs(here - other);
  vec2 on_edge = at + 0.5 * side * across;
  float back = 0.0, forth = 0.0, back_end = 0.0, forth_end = 0.0;
  for (int i = 0; i < steps; ++i) {
    bool back_walks = abs(back_end) < slack, forth_walks = abs(forth_end) < slack;
    if (!back_walks && !forth_walks) break;
    float stride = i < 3 ? 1.0 : 2.0;
    back += back_walks ? stride : 0.0;
    forth += forth_walks ? stride : 0.0;
    back_end = textureLod(picture, on_edge - back * along, 0.0).g - middle;
    forth_end = textureLod(picture, on_edge + forth * along, 0.0).g - middle;
  }
  // The nearer end determines whether the step covers this pixel, and how much of it.
  float end = back < forth ? back_end : forth_end;
  bool covered = (end < 0.0) != (here < middle);
  float share = covered ? 0.5 - min(back, forth) / (back + forth) : 0.0;
  // A thin line is not a step: its pixels differ from the neighbours on both sides.
  float thin = smoothstep(0.0, 1.0, abs(0.25 * (up + down + left + right) - here) / (high - low));
  pixel = textureLod(picture, at + max(share, 0.5 * thin * thin) * side * across, 0.0);
}
