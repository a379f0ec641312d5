// The tool: a body of revolution around y, scaled by `stretch`.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;

uniform float stretch;

out vec3 world;
out vec3 surface_normal;

void main() {
  surface_normal = normal;
  world = position * stretch;
  gl_Position = view_projection * vec4(world, 1.0);
}
