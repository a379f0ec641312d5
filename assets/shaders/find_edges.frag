// First pass of the edge filter. It copies the picture and writes the depth 0 at edges and 1 elsewhere. An edge is where
// the brightness of neighbours differs (edges.frag); green is used as brightness. The result is upside down
// (SmoothTarget::end).
uniform sampler2D picture;

out vec4 pixel;

const float kLeastContrast = 1.0 / 32.0;  // smaller differences are not visible
const float kShare = 1.0 / 12.0;          // of the largest brightness; smaller differences are not visible either

void main() {
  ivec2 last = textureSize(picture, 0) - 1;
  ivec2 texel = ivec2(gl_FragCoord.xy);
  texel.y = last.y - texel.y;
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
