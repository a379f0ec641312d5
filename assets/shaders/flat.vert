// A rectangle of the picture of a block.
layout(location = 0) in vec3 position;  // a square of half side 1 in x and z

uniform vec2 cell;    // size of that picture, pixels
uniform vec2 origin;  // pixels, y down
uniform vec2 low;     // corners relative to `origin`, pixels, y down
uniform vec2 high;

out vec2 at;     // relative to `origin`, pixels, y down
out vec2 share;  // of the rectangle, 0..1

void main() {
  share = 0.5 + 0.5 * position.xz;
  at = mix(low, high, share);
  gl_Position = vec4(2.0 * (origin + at) / cell - 1.0, 0.0, 1.0);
}
