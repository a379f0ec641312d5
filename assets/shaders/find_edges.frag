// The picture as it is, and in the depth where it has an edge: 0 there, 1 elsewhere. An edge is where brightness
// jumps between neighbours (edges.frag). Green stands for brightness.
uniform sampler2D picture;
uniform vec2 corner;  // of what is drawn into, pixels

out vec4 pixel;

const float kLeastContrast = 1.0 / 32.0;  // less is no edge that is seen
const float kShare = 1.0 / 12.0;          // nor is less than this of what is bright there

void main() {
  ivec2 last = textureSize(picture, 0) - 1;
  ivec2 texel = ivec2(gl_FragCoord.xy - corner);
  ivec2 low_end = max(texel - 1, 0), high_end = min(texel + 1, last);
  pixel = texelFetch(picture, texel, 0);
  float up = texelFetch(picture, ivec2(texel.x, high_end.y), 0).g;
  float down = texelFetch(picture, ivec2(texel.x, low_end.y), 0).g;
  float left = texelFetch(picture, ivec2(low_end.x, texel.y), 0).g;
  float right = texelFetch(picture, ivec2(high_end.x, texel.y), 0).g;
  float high = max(pixel.g, max(max(up, down), max(left, right)));
  float low = min(pixel.g, min(min(up, down), min(left, right)));
  gl_FragDepth = high - low < max(kLeastContrast, kShare * high) ? 1.0 : 0.0;
}
