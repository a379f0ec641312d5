// How late the force channel is against the position channel.
//
// A material's memory only lets the force run ahead of the depth (it relaxes), never
// behind, but a fit of depth alone would call relaxation a lead and hide a lag. So the
// force is fitted by least squares with powers of the depth and of relaxed depths,
//   f(t) ~ sum_k a_k u^k + b_k r_1[u^k] + c_k r_2[u^k],   u = (p(t - lag) - surface)+
// (r_1, r_2: first-order low-passes of 0.08 and 0.8 s), for lags of -20 to 100 ms, and the
// lag with the smallest residual is taken. The onset of contact, which no such term
// can move, decides.
// Thread guarantee: slow side, pure.
#pragma once

#include "engine/recording/recording.h"

namespace palpate {

struct ForceLag {
  bool known = false;        // false: sampled too slowly, or nothing to tell by
  double lag_s = 0.0;        // positive: the force is late
  double improvement = 1.0;  // residual at that lag over that without
};

ForceLag find_force_lag(const Recording& recording);

// The recording with the force moved back by `lag_s`; the end is cut off.
Recording without_lag(const Recording& recording, double lag_s);

}  // namespace palpate
