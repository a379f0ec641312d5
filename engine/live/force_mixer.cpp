#include "engine/live/force_mixer.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kJndTime_s = 0.01;
// A rising force increases its own JND by up to 3 % within 10 ms. This share of the JND compensates for that and for
// rounding.
constexpr double kShareOfJnd = 0.95;

}  // namespace

void ForceMixer::jump_to(std::size_t selected) noexcept {
  weights_.fill(0.0);
  weights_[selected] = 1.0;
}

double ForceMixer::current(const Forces& forces_N) const noexcept {
  double force_N = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i)
    if (weights_[i] != 0.0) force_N += weights_[i] * forces_N[i];
  return force_N;
}

double ForceMixer::mix(const Forces& forces_N, std::size_t selected, double step_s) noexcept {
  // After the fade the force has the bits of the model.
  if (settled_on(selected)) return forces_N[selected];
  const double force_N = current(forces_N), difference_N = forces_N[selected] - force_N;
  const double step = step_s > 0.0 ? std::min(step_s, kJndTime_s) : 0.0;
  const double jnd_N = jnd_.at(std::min(std::abs(force_N), std::abs(forces_N[selected])));
  const double most_N = kShareOfJnd * jnd_N * step / kJndTime_s;
  if (!(std::abs(difference_N) > most_N)) {
    jump_to(selected);
    return forces_N[selected];
  }
  const double share = most_N / std::abs(difference_N);
  for (double& weight : weights_) weight *= 1.0 - share;
  weights_[selected] += share;
  return force_N + share * difference_N;
}

}  // namespace palpate
