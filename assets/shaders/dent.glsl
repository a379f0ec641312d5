// Depth of the dent at the distance `r` from the ball's axis, and its slope (rendering/picture/dent.h):
//   r <= a:  u = d - R + sqrt(R^2 - r^2)                                        the ball
//   r >  a:  u = u_a (2 / pi) ((2 - x^2) asin(1 / x) + sqrt(x^2 - 1)), x = r / a    the half-space beside it
// It fades towards the rim, so that the sides stand still.
uniform float dent;         // d, metres
uniform float contact;      // a, metres, above 0
uniform float edge;         // u_a, metres
uniform float tool_radius;  // R, metres
uniform float rim;          // metres from the middle to the nearest side

float dent_at(float r, out float slope) {
  const float kPi = 3.14159265;
  float inner = min(r, contact);
  float ball = sqrt(tool_radius * tool_radius - inner * inner);
  float x = max(r / contact, 1.0);
  float root = sqrt(x * x - 1.0);
  float angle = asin(1.0 / x);
  bool touches = r < contact;
  float u = touches ? dent - tool_radius + ball : edge * (2.0 / kPi) * ((2.0 - x * x) * angle + root);
  slope = touches ? -inner / ball : edge / contact * (4.0 / kPi) * (root / x - x * angle);
  float out_there = clamp((r / rim - 0.35) / 0.55, 0.0, 1.0);
  float kept = 1.0 - out_there * out_there * (3.0 - 2.0 * out_there);
  slope = slope * kept - u * 6.0 * out_there * (1.0 - out_there) / (0.55 * rim);
  bool pressed = dent > 0.0;
  slope = pressed ? slope : 0.0;
  return pressed ? u * kept : 0.0;
}
