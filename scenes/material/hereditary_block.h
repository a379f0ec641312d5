// A block with an elastic response and a memory of it, quasi-linear viscoelasticity:
//   F = E(s) + integral K(t - u) dE(s)/du du
// E is the law's, K its spectrum (relaxation_spectrum.h); laws add to it what else they have.
// Passive: see relaxation_spectrum.h.
// Thread guarantee: as Block.
#pragma once

#include "scenes/material/block.h"
#include "scenes/material/relaxation_spectrum.h"

namespace palpate {

class HereditaryBlock : public Block {
 public:
  // E(depth), newtons; rises with the depth.
  virtual double elastic_force_N(double depth_m) const noexcept = 0;

  double held_force_N(double depth_m) const noexcept override {
    return elastic_force_N(depth_m) * (1.0 + 0.5 * spectrum_.total_weight());
  }
  double relaxed_force_N(double depth_m) const noexcept override { return elastic_force_N(depth_m); }

 protected:
  explicit HereditaryBlock(const RelaxationSpectrum& spectrum) : spectrum_(spectrum) {}

  // `share` of E and all of the memory, should the surface go to `surface_m`.
  double hereditary_force_N(double surface_m, double share = 1.0) const noexcept {
    const double elastic_N = elastic_force_N(surface_m);
    return share * elastic_N + spectrum_.memory_N(elastic_N - elastic_N_);
  }

  void prepare() noexcept override { spectrum_.prepare(substep_s()); }
  void begin_substep() noexcept override { spectrum_.relax(); }
  double contact_force_N(double surface_m, double) const noexcept override { return hereditary_force_N(surface_m); }
  void settle(double surface_m, bool) noexcept override {
    const double elastic_N = elastic_force_N(surface_m);
    spectrum_.settle(elastic_N - elastic_N_);
    elastic_N_ = elastic_N;
  }
  void forget(double surface_m) noexcept override {
    spectrum_.forget();
    elastic_N_ = elastic_force_N(surface_m);
  }

 private:
  RelaxationSpectrum spectrum_;
  double elastic_N_ = 0.0;  // E at the last surface
};

}  // namespace palpate
