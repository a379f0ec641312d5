// The surface of a soft half-space under a rigid ball.
// Thread guarantee: pure functions.
#pragma once

namespace palpate {

// The depth u of the surface at the distance r from the middle. Inside the contact it follows the ball of radius R,
// u = d - R + sqrt(R^2 - r^2). Outside it has the shape beside a Hertzian contact,
// u = u_a (2 / pi) ((2 - x^2) asin(1 / x) + sqrt(x^2 - 1)) with x = r / a (Johnson 1985, eq. 3.42a).
// An incompressible material moves along the normal only.
struct DentShape {
  float depth_m = 0.0F;     // d, in the middle
  float contact_m = 1e-6F;  // a, radius of the contact
  float edge_m = 0.0F;      // u_a, depth at the edge of the contact
};

// At the edge of the contact both shapes have the same slope: with q = sqrt(R^2 - a^2), 3 q^2 + 2 (d - R) q - R^2 = 0.
// A shallow dent has Hertz's a^2 = R d, a deep one nearly Sneddon's (1965).
// `depth_m`: any; there is no dent at 0 or below. `radius_m`: R > 0.
DentShape dent_under_ball(float depth_m, float radius_m) noexcept;

}  // namespace palpate
