// A soft material. Light wraps around it and shines through thin parts (Barre-Brisebois and Bouchard 2011). Its surface
// reflects the room at grazing angles. A printed grid follows its deformation. While the ball presses, the colour of the
// error spreads in it from the contact. TOP: the upper face; else the sides. PORES and DOME are defined for the materials
// that need them.
in vec3 material;
in vec3 world;
in vec3 surface_normal;
in float sunk;

uniform vec3 colour;
uniform vec3 half_size;     // of the whole block, y its whole height, metres
uniform vec3 mark_colour;   // of the error
uniform float mark;         // its opacity, 0..1
uniform float tip;          // depth of the tool's tip below the undisturbed top, metres
uniform float translucent;  // 0..1
uniform float gloss;        // 0..1
uniform float pores;        // 0..1
uniform float grid;         // opacity of its lines, 0..1
uniform vec3 outline_colour;  // of the coloured dent
uniform float outline_width;  // pixels

out vec4 pixel;

#ifdef TOP
// Share of the lamp's light that the tool occludes: its shadow falls away from the lamp, and is softer the higher the
// part that casts it.
float shadow() {
  vec2 fall = -light.xz / light.y;  // displacement of a shadow per height
  vec2 at = material.xz + max(-tip, 0.0) * -fall;
  float along = dot(at, fall) / dot(fall, fall);
  float from = length(at - along * fall);
  float soft = 0.0015 + 0.10 * max(along, 0.0);
  float width = tool_radius * mix(0.95, 0.45, smoothstep(1.2, 2.2, along / tool_radius));
  return (1.0 - smoothstep(width - soft, width + soft, from)) * smoothstep(-soft, soft, along + 0.5 * tool_radius) *
         (1.0 - smoothstep(1.0, 5.0, along / tool_radius)) * (1.0 - smoothstep(0.62, 0.88, length(material.xz) / rim));
}
#endif

void main() {
  vec3 n = normalize(surface_normal);
  vec3 to_eye = normalize(eye - world);
  float facing = max(dot(n, to_eye), 0.0);
  vec3 own = colour / max(max(colour.r, colour.g), colour.b);
  vec3 base = colour;
  // Distance to the nearest edge: the second smallest of the distances to the three faces.
  vec3 inside = max(vec3(half_size.x - abs(material.x), -material.y, min(half_size.z + material.z, -material.z)), 0.0);
  float edge_m = max(min(inside.x, inside.z), min(max(inside.x, inside.z), inside.y));
  float thin = exp(-edge_m / 0.005);
  float up = 1.0 + material.y / half_size.y;
  float open = 0.55 + 0.45 * smoothstep(0.0, 0.22, up);  // the table occludes the foot
  float lamp = 1.0;
  float spread = 0.0;

#ifdef DOME
  // The dome is a darker piece of rubber.
  float r = length(material.xz);
  base *= 1.0 - 0.35 * (dome > 0.0 ? clamp((dome_radius - r) / fwidth(r) + 0.5, 0.0, 1.0) : 0.0);
#endif
#if defined(TOP)
  // Ambient occlusion by the ball (its solid angle) and by the walls of the dent.
  vec3 to_ball = vec3(0.0, tool_radius - tip, 0.0) - world;
  float ball_m = max(length(to_ball), 1e-4);
  float ball = clamp(dot(n, to_ball) * tool_radius * tool_radius / (ball_m * ball_m * ball_m), 0.0, 1.0);
  open *= (1.0 - 0.75 * ball) * (1.0 - 0.45 * sunk * sqrt(min(dent / tool_radius, 1.0)));
  lamp = 1.0 - 0.65 * shadow();
  vec2 px_per_m = 1.0 / fwidth(material.xz);
  base *= 1.0 - grid * max(line_of_grid(material.x, 0.01, px_per_m.x), line_of_grid(material.z, 0.01, px_per_m.y));
  thin += 0.6 * sunk * (1.0 - sunk);
  spread = smoothstep(0.28, 0.36, sunk);
#endif
  base = mix(base, mark_colour, mark * spread);
#ifdef PORES
  base *= 1.0 - pores * pits(material, abs(n), length(fwidth(material)));
#endif

  vec3 back = normalize(vec3(0.45, 0.35, -0.80));  // light from behind that shines through
  float behind = max(dot(to_eye, -normalize(back + 0.4 * n)), 0.0);
  float through = 0.30 + 0.9 * behind * behind;
  vec3 room = mix(vec3(0.30, 0.29, 0.28), vec3(0.44, 0.45, 0.46), 0.5 + 0.5 * n.y);
  vec3 lit = base * (room * open + 0.62 * lamp * wrapped(n, mix(vec3(0.15), 0.55 * own * own, translucent)) *
                                       mix(1.0, open, 0.4));
  lit += own * own * colour * translucent * through * thin * mix(0.45, 1.0, open) * (1.0 - 0.7 * mark * spread);
  vec3 mirrored = 2.0 * dot(n, to_eye) * n - to_eye;
  float grazing = 1.0 - facing;
  float fresnel = 0.04 + 0.96 * grazing * grazing * grazing * grazing * grazing;
  lit += gloss * open * (0.9 * fresnel * mirrored_room(mirrored) + 0.38 * lamp * mirrored_lamp(mirrored));
#ifdef TOP
  float ring = mark * clamp(0.6 * outline_width + 0.5 - abs(sunk - 0.30) / max(fwidth(sunk), 1e-4), 0.0, 1.0);
  lit = mix(lit, outline_colour, ring);
#endif
  pixel = vec4(lit, 1.0);
}
