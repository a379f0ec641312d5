// Maxwell branches for all relaxation times tau_t and all drive curves g_k at once: the outputs z_tk of
//   dz/dt = g_k'(s) ds/dt - z / tau_t
// with s the depth of the material's surface (engine/tick/features.h), discretised as there. Each curve is evaluated
// once a sample and each decay once a relaxation time.
// Thread guarantee: value type, slow side.
#pragma once

#include <vector>

#include "engine/tick/features.h"

namespace palpate {

class BranchLadder {
 public:
  // `times_s`: relaxation times. `slowing`: growth of all relaxation times with depth (FeatureSpec::slowing); its
  // depth is normalised by the reference depth of the first curve.
  BranchLadder(std::vector<double> times_s, std::vector<DriveCurve> curves, double slowing);

  void reset() { started_ = false; }
  // Adds the next sample; times increase. `depth_m`: depth of the tool, at most `surface_m`, that of the surface.
  void update(double time_s, double depth_m, double surface_m);
  // z_tk, index t * curves + k.
  const std::vector<double>& values() const { return values_; }

 private:
  std::vector<double> times_s_;
  std::vector<DriveCurve> curves_;
  double slowing_;
  std::vector<double> values_;
  std::vector<double> drive_;  // g_k at the last sample
  std::vector<double> change_;
  double time_s_ = 0.0;
  double depth_m_ = 0.0;
  double surface_m_ = 0.0;
  bool started_ = false;
};

}  // namespace palpate
