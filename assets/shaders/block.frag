// A soft material. Light wraps around it and shines through thin parts (Barre-Brisebois and Bouchard 2011). Its surface
// reflects the room at grazing angles. A printed grid follows its deformation. The ball occludes ambient light near the
// contact; tool and arrow cast shadows. PORES and DOME are defined for the materials that need them.
in vec3 material;
in vec3 world;
in vec3 surface_normal;

uniform vec3 colour;
uniform vec3 mark_colour;   // of the error over the JND
uniform float mark;         // its opacity, 0..1
uniform vec3 frame_colour;
uniform float frame;        // width of the frame along the rim of the top, metres; 0: none
uniform float translucent;  // 0..1
uniform float gloss;        // 0..1
uniform float pores;        // 0..1
uniform float grid;         // opacity of its lines, 0..1
uniform vec3 outline_colour;  // of the dent and the frame
uniform float outline_width;  // pixels
uniform vec3 half_size;     // of the block, y its whole height, metres
uniform float tip;          // depth of the tool's tip below the undisturbed top, metres
uniform vec3 arrow;         // x, z: its foot relative to the middle; y: its length; metres

out vec4 pixel;

const float kLineWidth = 0.0005;  // of the grid, metres

// Coverage of this pixel by lines of the grid at a distance of `step` metres.
float line_of_grid(float at, float step, float pixel_m) {
  float away = abs(fract(at / step + 0.5) - 0.5) * step;
  return clamp((0.5 * kLineWidth - away) / pixel_m + 0.5, 0.0, 1.0) * min(1.0, kLineWidth / pixel_m);
}

// Every second line is stronger.
float lines(vec2 at) {
  vec2 pixel_m = fwidth(at);
  float all = max(line_of_grid(at.x, tool_radius, pixel_m.x), line_of_grid(at.y, tool_radius, pixel_m.y));
  float strong = max(line_of_grid(at.x, 2.0 * tool_radius, pixel_m.x), line_of_grid(at.y, 2.0 * tool_radius, pixel_m.y));
  return max(strong, 0.5 * all);
}

// Coverage of this pixel by the frame (x), and by the frame with the lines beside it (y).
vec2 framed(vec2 at) {
  const float kRim = 0.004, kCorner = 0.012;  // as in rendering/picture/mesh.cpp
  vec2 q = abs(at) - (half_size.xz - kRim - kCorner);
  float inside = kCorner - length(max(q, 0.0)) - min(max(q.x, q.y), 0.0);
  float away = abs(inside - frame) - 0.5 * frame;  // distance from the frame, negative in it
  float pixel_m = fwidth(inside);
  return clamp(0.5 - vec2(away, away - 0.25 * frame) / pixel_m, 0.0, 1.0) * step(1e-6, frame);
}

#ifdef PORES
float random(vec2 cell) { return fract(sin(dot(cell, vec2(12.9898, 78.233))) * 43758.5453); }

// Coverage by small pits, on all sides.
float pits(vec3 at) {
  vec3 side = abs(surface_normal);
  vec2 place = (side.y > 0.5 ? at.xz : side.x > 0.5 ? at.zy : at.xy) / 0.0016;
  vec2 cell = floor(place);
  vec2 middle = vec2(random(cell), random(cell + 7.3)) * 0.5 + 0.25;
  float size = 0.12 + 0.26 * random(cell + 3.1);
  float pixel_size = fwidth(place.x) + fwidth(place.y);
  return (1.0 - smoothstep(size - pixel_size, size + pixel_size, length(place - cell - middle))) /
         (1.0 + 1.5 * pixel_size);
}
#endif

// Width of the penumbra of something that is `along` metres above this point, metres.
float penumbra(float along) { return 0.0006 + 0.16 * max(along, 0.0); }

// Share of the lamp's light that an upright body occludes. The ray to the lamp passes the axis of the body at the height
// `along` above this point and at the distance `from`. The body has the radius `width` there and extends from `low` to
// `high`.
float shadow_of(float along, float from, float width, float low, float high) {
  float soft = penumbra(along);
  return (1.0 - smoothstep(-soft, soft, from - width)) * smoothstep(low - soft, low + soft, along) *
         (1.0 - smoothstep(high - 2.0 * soft, high + 2.0 * soft, along)) * width / (width + 0.6 * soft);
}

float shadows(vec3 at) {
  vec2 fall = -light.xz / light.y;  // displacement of a shadow per height
  float along = dot(at.xz, fall) / dot(fall, fall);
  float from = length(at.xz - along * fall);
  // Ball, stem, sensor and handle, in radii of the ball. Their radii change over the width of the penumbra, because a
  // sudden change would draw the outline of a wedge.
  float high = (along + at.y + tip) / tool_radius;
  float soft = 0.15 + penumbra(along) / tool_radius;
  float ball = sqrt(max(1.0 - (high - 1.0) * (high - 1.0), 0.0));
  float shaft = mix(mix(0.30, 1.40, smoothstep(5.9 - soft, 5.9 + soft, high)), 1.05,
                    smoothstep(7.0 - soft, 7.0 + soft, high));
  float width = max(ball, shaft) * tool_radius;
  float lost = shadow_of(along, from, width, -at.y - tip, 15.0 * tool_radius - at.y - tip);
  vec2 beside = at.xz - arrow.xz;
  along = dot(beside, fall) / dot(fall, fall);
  from = length(beside - along * fall);
  return max(lost, shadow_of(along, from, 0.0016, 0.0, arrow.y));
}

void main() {
  float r = length(material.xz);
  float top = smoothstep(0.99, 0.999, surface_normal.y);
  Surface surface = surface_at(r);
  vec3 at = material - vec3(0.0, top * surface.depth, 0.0);
  float sunk = clamp(surface.given / max(dent, 1e-6), 0.0, 1.0) * top;
  vec3 n = normalize(surface_normal + top * surface.slope * vec3(material.x, 0.0, material.z) / max(r, 1e-6));
  vec3 to_eye = normalize(eye - world);
  float facing = max(dot(n, to_eye), 0.0);

  vec3 base = colour;
#ifdef DOME
  // The dome is a darker piece of rubber.
  base *= 1.0 - 0.35 * (dome > 0.0 ? clamp((dome_radius - r) / fwidth(r) + 0.5, 0.0, 1.0) : 0.0);
#endif
  base = mix(base, mark_colour, mark * smoothstep(0.28, 0.36, sunk));
  base *= 1.0 - top * grid * lines(material.xz);
#ifdef PORES
  base *= 1.0 - pores * pits(material);
#endif

  // Ambient occlusion by the ball (its solid angle), by the walls of the dent and by the table.
  vec3 to_ball = vec3(0.0, tool_radius - tip, 0.0) - at;
  float ball_m = length(to_ball);
  float ball = clamp(dot(n, to_ball) * tool_radius * tool_radius / (ball_m * ball_m * ball_m), 0.0, 1.0);
  float up = 1.0 + material.y / half_size.y;
  float open = (1.0 - 0.8 * ball) * (1.0 - 0.75 * sunk * sqrt(min(dent / tool_radius, 1.0))) *
               (0.55 + 0.45 * smoothstep(0.0, 0.22, up));

  // Distance to the nearest edge: the second smallest of the distances to the three faces.
  vec3 inside = max(vec3(half_size.x - abs(material.x), -material.y, half_size.z - abs(material.z)), 0.0);
  float edge_m = max(min(inside.x, inside.z), min(max(inside.x, inside.z), inside.y));
  float thin = exp(-edge_m / 0.006) + 0.7 * sunk * (1.0 - sunk);
  vec3 back = normalize(vec3(0.45, 0.35, -0.80));  // light from behind that shines through
  float behind = max(dot(to_eye, -normalize(back + 0.4 * n)), 0.0);
  float through = 0.30 + 0.9 * behind * behind;
  vec3 own = colour / max(max(colour.r, colour.g), colour.b);

  float lamp = 1.0 - 0.75 * shadows(at) * top;
  vec3 room = mix(vec3(0.30, 0.29, 0.28), vec3(0.44, 0.45, 0.46), 0.5 + 0.5 * n.y);
  vec3 lit = base * (room * open + 0.62 * lamp * wrapped(n, mix(vec3(0.15), 0.55 * own * own, translucent)) *
                                       mix(1.0, open, 0.4));
  lit += own * own * colour * translucent * through * thin * mix(0.45, 1.0, open);

  vec3 mirrored = 2.0 * dot(n, to_eye) * n - to_eye;
  float grazing = 1.0 - facing;
  float fresnel = 0.04 + 0.96 * grazing * grazing * grazing * grazing * grazing;
  lit += gloss * open * (0.9 * fresnel * mirrored_room(mirrored) + 0.30 * lamp * mirrored_lamp(mirrored, 28.0));
  // Lines separate the coloured dent and the frame from a material of similar brightness.
  float ring = clamp(0.6 * outline_width + 0.5 - abs(sunk - 0.30) / max(fwidth(sunk), 1e-4), 0.0, 1.0);
  lit = mix(lit, outline_colour, mark * ring);
  vec2 cover = framed(material.xz) * top;
  lit = mix(mix(lit, outline_colour, cover.y), frame_colour, cover.x);
  pixel = vec4(lit, 1.0);
}
