#include "scenes/material/tissue_block.h"

#include <cmath>

namespace palpate {
namespace {

// Of the power law, per unit of ln tau.
double density(double time_s) {
  return TissueBlock::kFractionalShare * std::pow(time_s, -TissueBlock::kExponent) /
         std::tgamma(TissueBlock::kExponent);
}

}  // namespace

TissueBlock::TissueBlock() : spectrum_(kShortest_s, kLongest_s, density) {
  // The integral of the density from the slowest time on.
  held_share_ = 1.0 - kFractionalShare + density(kLongest_s) / kExponent;
}

std::string TissueBlock::relaxation_times_text() const { return "a power law of time, t^-0.15"; }

double TissueBlock::contact_force_N(double surface_m, double) const noexcept {
  const double elastic_N = kContact.force_N(surface_m);
  return held_share_ * elastic_N + spectrum_.memory_N(elastic_N - elastic_N_);
}

void TissueBlock::settle(double surface_m, bool) noexcept {
  const double elastic_N = kContact.force_N(surface_m);
  spectrum_.settle(elastic_N - elastic_N_);
  elastic_N_ = elastic_N;
}

void TissueBlock::forget(double surface_m) noexcept {
  spectrum_.forget();
  elastic_N_ = kContact.force_N(surface_m);
}

}  // namespace palpate
