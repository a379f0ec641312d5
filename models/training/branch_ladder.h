// The basis of a branch for many relaxation times at once: z_tk of every time tau_t and
// every curve g_k, driven by the depth of the material's surface as in
// engine/tick/features.h, by the steps of that file. The curves are evaluated once a sample and the decay once a
// time, so a ladder of twenty times costs little more than one.
// Thread guarantee: value type, slow side.
#pragma once

#include <vector>

#include "engine/tick/features.h"

namespace palpate {

class BranchLadder {
 public:
  // `slowing`: of all times, over the curves' reference depth.
  BranchLadder(std::vector<double> times_s, std::vector<DriveCurve> curves, double slowing);

  void reset() { started_ = false; }
  // The next sample; times increase. `depth_m`: of the tool, at most that of the surface.
  void update(double time_s, double depth_m, double surface_m);
  // One value for each time and curve, times outside.
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
