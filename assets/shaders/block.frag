#version 330 core
// A soft material: light from a wide lamp and from the room, a little that comes
// through thin places, and less of it where the surface is hollow.
in vec3 world;
in vec3 surface_normal;
in float axis_distance;
in float sunk;

uniform vec3 eye;
uniform vec3 light;       // towards it
uniform vec3 colour;
uniform vec3 mark_colour; // error over the JND
uniform float mark;       // how much of it shows, 0..1
uniform float dent;       // metres
uniform float tool_gap;   // metres between the tip and the surface; 0 in contact
uniform float tool_radius;
uniform float height;     // metres, of the block
uniform vec3 offset;      // the middle of the block's top

out vec4 pixel;

void main() {
  vec3 n = normalize(surface_normal);
  vec3 to_eye = normalize(eye - world);
  float up = clamp((world.y - offset.y) / height + 1.0, 0.0, 1.0);
  float facing = max(dot(n, to_eye), 0.0);
  float wrapped = max((dot(n, light) + 0.35) / 1.35, 0.0);
  float room = 0.5 + 0.5 * n.y;
  float marked = mark * smoothstep(0.16, 0.55, sunk);
  vec3 base = mix(colour, mark_colour, marked);
  // The block stands on something: the last millimetres get little light.
  float standing = 0.62 + 0.38 * smoothstep(0.0, 0.16, up);
  // The hollow's own walls keep light from its middle.
  float hollow = 1.0 - 0.30 * sunk * sunk * min(dent / tool_radius, 1.0);
  // The tool's shadow falls away from the lamp, sharper and darker the nearer it is.
  vec2 fallen = world.xz - offset.xz + tool_gap * light.xz / light.y;
  float spread = tool_radius * 0.95 + 0.8 * tool_gap;
  float falling = 1.0 + 0.6 * dot(fallen, fallen) / (spread * spread);
  float shadow = n.y > 0.2 ? 0.42 / (falling * falling * (1.0 + 70.0 * tool_gap)) : 0.0;
  vec3 ambient = mix(vec3(0.30, 0.29, 0.28), vec3(0.45, 0.46, 0.47), room);
  float through = 0.10 * (1.0 - facing) * (0.4 + 0.6 * up);
  vec3 lit = base * ((ambient + through) * standing * hollow + 0.60 * wrapped * (1.0 - shadow) * mix(1.0, hollow, 0.5));
  float shine = max(dot(2.0 * dot(n, to_eye) * n - to_eye, light), 0.0);
  shine *= shine;
  shine *= shine;
  shine *= shine;
  pixel = vec4(lit + vec3(0.07 * shine), 1.0);
}
