// Depth of the surface at the distance `r` from the ball's axis, and its slope (rendering/picture/gpu.h):
//   r <= a:  u = d - R + sqrt(R^2 - r^2)                                            the ball
//   r >  a:  u = u_a (2 / pi) ((2 - x^2) asin(1 / x) + sqrt(x^2 - 1)), x = r / a    the half-space beside it
// The depth decreases to 0 towards the rim, so that the sides do not move.
// With DOME: a dome of the rise h and the radius b has the depth u_0 = h r^2 / b^2 up to its foot at b. After the snap
// its middle is mirrored at the depth d / 2; a thin shell can take this shape without stretching (Pogorelov 1988).
uniform float dent;         // d, metres
uniform float contact;      // a, metres, above 0
uniform float edge;         // u_a, metres
uniform float tool_radius;  // R, metres
uniform float rim;          // metres from the middle to the nearest side
uniform float dome;         // h, metres; 0: the sides of the block
uniform float dome_radius;  // b, metres

struct Surface {
  float depth;  // metres below the undisturbed top
  float slope;
  float given;  // displacement by the ball, metres
};

Surface surface_at(float r) {
  const float kPi = 3.14159265;
  float inner = min(r, contact);
  float ball = sqrt(tool_radius * tool_radius - inner * inner);
  float x = max(r / contact, 1.0);
  float root = sqrt(x * x - 1.0);
  float angle = asin(1.0 / x);
  bool touches = r < contact;
  float u = touches ? dent - tool_radius + ball : edge * (2.0 / kPi) * ((2.0 - x * x) * angle + root);
  float slope = touches ? -inner / ball : edge / contact * (4.0 / kPi) * (root / x - x * angle);
  float out_there = clamp((r / rim - 0.35) / 0.55, 0.0, 1.0);
  float kept = 1.0 - out_there * out_there * (3.0 - 2.0 * out_there);
  slope = slope * kept - u * 6.0 * out_there * (1.0 - out_there) / (0.55 * rim);
  bool pressed = dent > 0.0;
  Surface here = Surface(pressed ? u * kept : 0.0, pressed ? slope : 0.0, 0.0);
  here.given = here.depth;
#ifdef DOME
  if (dome <= 0.0) return here;
  float inside = max(1.0 - r * r / (dome_radius * dome_radius), 0.0);
  float rest = dome * (1.0 - inside);
  float rest_slope = inside > 0.0 ? dome * 2.0 * r / (dome_radius * dome_radius) : 0.0;
  float mirror = min(0.5 * dent, dome);
  float above = rest - mirror;
  float ridge = sqrt(above * above + 0.01 * dome * dome * inside);  // rounded, except at the foot of the dome
  float through = smoothstep(0.4 * dome, 1.1 * dome, dent);
  // When all of the dome is inverted, the ball dents the block below.
  bool below = here.depth > mirror + ridge;
  here.depth = mix(rest + here.depth, below ? here.depth : mirror + ridge, through);
  here.slope = mix(rest_slope + here.slope, below ? here.slope : rest_slope * above / max(ridge, 1e-6), through);
  here.given = here.depth - rest;
#endif
  return here;
}
