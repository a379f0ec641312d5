#include "models/training/branch_ladder.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {

BranchLadder::BranchLadder(std::vector<double> times_s, std::vector<DriveCurve> curves, double slowing)
    : times_s_(std::move(times_s)),
      curves_(std::move(curves)),
      slowing_(slowing),
      values_(times_s_.size() * curves_.size(), 0.0),
      drive_(curves_.size(), 0.0),
      change_(curves_.size(), 0.0) {}

void BranchLadder::update(double time_s, double depth_m, double surface_m) {
  if (times_s_.empty()) return;
  for (std::size_t k = 0; k < curves_.size(); ++k) {
    const double drive = curves_[k].at(surface_m);
    change_[k] = drive - drive_[k];
    drive_[k] = drive;
  }
  const double step_s = time_s - time_s_;
  if (!started_) {
    std::fill(values_.begin(), values_.end(), 0.0);
  } else if (step_s > 0.0) {
    const double halfway_m = surface_halfway(surface_m_, depth_m_, depth_m);
    const double factor = relaxation_time_factor(slowing_, halfway_m, curves_.front().reference_depth_m);
    double* value = values_.data();
    for (const double relaxation_time_s : times_s_) {
      const BranchStep step = branch_step(factor * relaxation_time_s, step_s);
      for (std::size_t k = 0; k < curves_.size(); ++k, ++value) {
        *value = step.keep * *value + step.gain * change_[k];
        if (std::abs(*value) < 1e-30) *value = 0.0;
      }
    }
  }
  started_ = true;
  time_s_ = time_s;
  depth_m_ = depth_m;
  surface_m_ = surface_m;
}

}  // namespace palpate
