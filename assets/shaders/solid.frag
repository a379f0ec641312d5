// Steel or rubber; steel reflects a studio: a bright ceiling, a soft box at each side, a dark floor. An outline
// separates it from what is behind.
in vec3 world;
in vec3 surface_normal;

uniform vec3 colour;
uniform float shininess;
uniform float glow;    // brightness in the shade
uniform vec3 outline_colour;
uniform float outline_width;  // pixels

out vec4 pixel;

float studio(vec3 d) {
  float ceiling = 0.75 * smoothstep(0.35, 0.85, d.y);
  float left = smoothstep(-0.30, -0.42, d.x) * smoothstep(-0.95, -0.80, d.x) * smoothstep(-0.25, 0.05, d.y);
  float right = 0.55 * smoothstep(0.50, 0.62, d.x) * smoothstep(0.90, 0.80, d.x) * smoothstep(-0.35, 0.0, d.y);
  return 0.14 + 0.22 * smoothstep(-0.6, 0.2, d.y) + ceiling + 0.85 * left + right;
}

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
  vec3 light_on_it = 0.06 + glow + 0.20 * n.y + 0.50 * wrapped(n, vec3(0.35));
  vec3 dull = colour * light_on_it + vec3(0.10 * edge * edge);
  vec3 polished = colour * (0.6 * glow + studio(mirrored)) + vec3(0.45 * mirrored_lamp(mirrored));
  vec3 lit = mix(dull, polished, shininess);
  pixel = vec4(mix(lit, outline_colour, outlined(facing, outline_width)), 1.0);
}
