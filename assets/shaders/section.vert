// The cut face of a block. The material below the surface moves with it, less with the depth, and not at all at the
// bottom. What is the same for many pixels is computed here, because pixels are what costs a software renderer time.
layout(location = 0) in vec3 position;  // metres; the flat top at y = 0

uniform vec3 colour;
uniform vec3 half_size;     // of the whole block, y its whole height, metres
uniform float translucent;  // 0..1

noperspective out vec3 material;  // position without deformation; z: its height with it
flat out vec3 lit;                // colour in this light

void main() {
  float sunk = surface_at(abs(position.x)).depth * (1.0 + position.y / half_size.y);
  material = vec3(position.xy, position.y - sunk);
  vec3 own = colour / max(max(colour.r, colour.g), colour.b);
  lit = 0.5 + 0.62 * wrapped(vec3(0.0, 0.0, 1.0), mix(vec3(0.15), 0.55 * own * own, translucent));
  gl_Position = view_projection * vec4(material.xz, 0.0, 1.0);
}
