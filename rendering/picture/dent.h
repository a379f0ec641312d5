// The surface of a soft half-space under a rigid ball.
// Thread guarantee: pure functions.
#pragma once

namespace palpate {

// Inside the contact the surface lies on the ball, u = d - R + sqrt(R^2 - r^2); outside it has the shape beside a
// Hertzian contact, u = u_a (2 / pi) ((2 - x^2) asin(1 / x) + sqrt(x^2 - 1)) with x = r / a (Johnson 1985, eq. 3.42a).
// An incompressible material moves along the normal only.
struct DentShape {
  float depth_m = 0.0F;     // d, of the middle
  float contact_m = 1e-6F;  // a, the contact's radius
  float edge_m = 0.0F;      // u_a, the depth there
};

// The contact ends where both meet with the same slope: with q = sqrt(R^2 - a^2) that is
// 3 q^2 + 2 (d - R) q - R^2 = 0. A shallow dent has Hertz's a^2 = R d, a deep one nearly Sneddon's (1965).
// `depth_m`: any, below 0 there is no dent; `radius_m`: above 0.
DentShape dent_under_ball(float depth_m, float radius_m) noexcept;

}  // namespace palpate
