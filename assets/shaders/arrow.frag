// A flat arrow that points up from its foot.
in vec2 at;

uniform vec3 colour;
uniform vec3 outline_colour;
uniform float outline_width;  // pixels
uniform float half_width;     // of the shaft, pixels; the head is three times as wide
uniform float height;         // pixels

out vec4 pixel;  // multiplied with its opacity

void main() {
  float head = min(4.5 * half_width, height), wide = 2.6 * half_width, neck = head - height;
  vec2 p = vec2(abs(at.x), at.y);
  float shaft = max(p.x - half_width, max(p.y, neck - p.y));
  float tip = max((p.x * head - (p.y + height) * wide) / length(vec2(head, wide)), p.y - neck);
  float away = min(shaft, tip);
  float cover = clamp(outline_width + 0.5 - away, 0.0, 1.0);
  pixel = vec4(mix(outline_colour, colour, clamp(0.5 - away, 0.0, 1.0)) * cover, cover);
}
