// Tool and arrow: a body of revolution around y, scaled by `stretch`. A block's outline: its sides, grown.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform vec3 offset;
uniform vec3 stretch;
uniform float grown;  // outwards, metres

out vec3 world;
out vec3 surface_normal;

void main() {
  surface_normal = normal / stretch;
  world = position * stretch + offset + grown * normalize(surface_normal);
  gl_Position = view_projection * vec4(world, 1.0);
}
