#version 330 core
// Silicone: soft, lit a little from within.
in vec3 world;
in vec3 surface_normal;
in float axis_distance;
in float sunk;

uniform vec3 eye;
uniform vec3 light;       // towards it
uniform vec3 colour;
uniform vec3 mark_colour; // error over the JND
uniform float mark;       // how much of it shows, 0..1
uniform float tool_gap;   // metres between the tip and the surface; 0 in contact
uniform float tool_radius;
uniform float height;     // metres, of the block
uniform float surface;    // y of the flat top

out vec4 pixel;

void main() {
  vec3 n = surface_normal;  // the mesh is fine enough: its length stays near 1
  vec3 to_eye = normalize(eye - world);
  float up = clamp((world.y - surface) / height + 1.0, 0.0, 1.0);
  float facing = max(dot(n, to_eye), 0.0);
  // Light that wraps around the edge and light that comes through.
  float wrapped = max((dot(n, light) + 0.45) / 1.45, 0.0);
  float through = 0.16 * (1.0 - facing) + 0.10 * up;
  float marked = mark * smoothstep(0.10, 0.42, sunk);
  vec3 base = mix(colour, mark_colour, marked);
  vec3 lit = base * (0.30 + 0.66 * wrapped + through) + vec3(0.03);
  lit *= 0.78 + 0.22 * smoothstep(0.0, 0.6, up);  // darker towards the table
  // The tool's shadow on the block: sharper and darker the nearer it is.
  float spread = tool_radius * 1.15 + 0.8 * tool_gap;
  float falling = 1.0 + 0.6 * axis_distance * axis_distance / (spread * spread);
  float shadow = 1.0 / (falling * falling * (1.0 + 90.0 * tool_gap));
  lit *= 1.0 - (n.y > 0.2 ? 0.34 : 0.0) * shadow * (1.0 - marked);
  float shine = max(dot(2.0 * dot(n, to_eye) * n - to_eye, light), 0.0);
  shine *= shine;
  shine *= shine;
  shine *= shine;
  pixel = vec4(lit + vec3(0.14 * shine), 1.0);
}
