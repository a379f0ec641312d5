layout(location = 0) in vec3 position;  // a square of half side 1

uniform float table_y;
uniform float reach;  // metres, half the side of what is drawn

out vec2 place;

void main() {
  place = position.xz * reach;
  gl_Position = view_projection * vec4(place.x, table_y, place.y, 1.0);
}
