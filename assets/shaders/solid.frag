// A polished or dull surface; polished ones reflect the room and the lamp. An outline separates it from what is behind.
in vec3 world;
in vec3 surface_normal;

uniform vec3 colour;
uniform float shininess;
uniform float shaded;  // 0: the colour as it is; 1: light and shadow
uniform float glow;    // brightness in the shade
uniform vec3 outline_colour;
uniform float outline_width;  // pixels

out vec4 pixel;

// Whether this pixel is within `width` pixels of where the surface turns away from the eye. `facing`: cosine of the
// angle to the eye, which near there is proportional to the root of the distance.
float outlined(float facing, float width) {
  return clamp(width + 0.5 - 0.5 * facing / max(fwidth(facing), 1e-4), 0.0, 1.0);
}

void main() {
  vec3 n = normalize(surface_normal);
  vec3 to_eye = normalize(eye - world);
  vec3 mirrored = 2.0 * dot(n, to_eye) * n - to_eye;
  float facing = max(dot(n, to_eye), 0.0);
  float edge = 1.0 - facing;
  vec3 light_on_it = mix(vec3(1.0), 0.06 + glow + 0.20 * n.y + 0.50 * wrapped(n, vec3(0.35)), shaded);
  vec3 dull = colour * light_on_it + vec3(0.12 * edge * edge * shininess);
  vec3 polished = colour * (glow + 0.95 * mirrored_room(mirrored)) + vec3(0.55 * mirrored_lamp(mirrored, 16.0));
  vec3 lit = mix(dull, polished, shininess);
  pixel = vec4(mix(lit, outline_colour, outlined(facing, outline_width)), 1.0);
}
