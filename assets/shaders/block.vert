// The rear half of a block of soft material, cut open at z = 0 (section.vert). TOP: its upper face, which deforms under
// the ball (dent.glsl).
layout(location = 0) in vec3 position;  // metres; the flat top at y = 0
layout(location = 1) in vec3 normal;

out vec3 material;  // position without deformation
out vec3 world;
out vec3 surface_normal;
out float sunk;  // share of the dent's depth

void main() {
  material = position;
  world = position;
  surface_normal = normal;
  sunk = 0.0;
#if defined(TOP)
  float r = length(position.xz);
  Surface surface = surface_at(r);
  world.y -= surface.depth;
  surface_normal = normalize(vec3(surface.slope * position.x, max(r, 1e-6), surface.slope * position.z));
  sunk = clamp(surface.given / max(dent, 1e-6), 0.0, 1.0);
#endif
  gl_Position = view_projection * vec4(world, 1.0);
}
