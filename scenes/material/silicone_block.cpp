#include "scenes/material/silicone_block.h"

namespace palpate {

SiliconeBlock::SiliconeBlock() : spectrum_(kShortest_s, kLongest_s, [](double) { return kWeight; }) {}

double SiliconeBlock::held_force_N(double depth_m) const noexcept {
  return kContact.force_N(depth_m) * (1.0 + 0.5 * spectrum_.total_weight());
}

std::string SiliconeBlock::relaxation_times_text() const { return "continuous, 0.001 s to 30 s"; }

double SiliconeBlock::contact_force_N(double surface_m, double) const noexcept {
  const double elastic_N = kContact.force_N(surface_m);
  return elastic_N + spectrum_.memory_N(elastic_N - elastic_N_);
}

void SiliconeBlock::settle(double surface_m, bool) noexcept {
  const double elastic_N = kContact.force_N(surface_m);
  spectrum_.settle(elastic_N - elastic_N_);
  elastic_N_ = elastic_N;
}

void SiliconeBlock::forget(double surface_m) noexcept {
  spectrum_.forget();
  elastic_N_ = kContact.force_N(surface_m);
}

}  // namespace palpate
