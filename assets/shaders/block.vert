// A block of soft material. Its top deforms under the ball (dent.glsl).
layout(location = 0) in vec3 position;  // metres; the flat top at y = 0
layout(location = 1) in vec3 normal;

uniform vec3 offset;

out vec3 material;  // position without deformation
out vec3 world;
out vec3 surface_normal;

void main() {
  material = position;
  surface_normal = normal;
  world = position + offset;
  if (normal.y > 0.999) world.y -= surface_at(length(position.xz)).depth;
  gl_Position = view_projection * vec4(world, 1.0);
}
