#include "engine/tick/features.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/base/text.h"

namespace palpate {
namespace {

// So fine that one step more or less does not show in the ninth decimal of a force.
constexpr double kSurfaceForce_N = 1e-11;
constexpr int kSurfaceSteps = 40;
// Nearer than this, below an atom, the surface has come back.
constexpr double kNoLag_m = 1e-12;

// What stands in lanes: branches, of which one alone is a spectrum of one, and stops.
std::size_t lane_count(const FeatureSpec& spec) noexcept {
  if (spec.kind == FeatureKind::maxwell_branch) return 1;
  return has_parts(spec.kind) ? spec.part_count : 0;
}
const DriveCurve& branch_drive(const FeatureSpec& spec, std::size_t part) noexcept {
  return spec.kind == FeatureKind::maxwell_branch ? spec.drive : spec.parts[part].drive;
}
double branch_time_s(const FeatureSpec& spec, std::size_t part) noexcept {
  return spec.kind == FeatureKind::maxwell_branch ? spec.relaxation_time_s : spec.parts[part].relaxation_time_s;
}

}  // namespace

double DriveCurve::at(double depth_m) const noexcept {
  return rising_curve(coefficient_N, has_knots ? &knot_N : nullptr, depth_m / reference_depth_m);
}

double surface_halfway(double last_surface_m, double last_depth_m, double depth_m) noexcept {
  const bool apart = last_surface_m > last_depth_m && last_surface_m > depth_m;
  return apart ? last_surface_m : 0.5 * (last_surface_m + depth_m);
}

double branch_clock(double slowing, double surface_m, double reference_depth_m) noexcept {
  if (slowing == 0.0) return 1.0;
  return std::exp(slowing * std::min(surface_m / reference_depth_m, 1.0));
}

double surface_position_m(const std::vector<FeatureSpec>& specs) noexcept {
  for (const FeatureSpec& spec : specs) {
    if (spec.kind == FeatureKind::depth) return spec.surface_position_m;
  }
  return 0.0;
}

std::string feature_name(const FeatureSpec& spec) {
  std::string name("feature_");
  name.append(facts_of(spec.kind).name);
  if (has_time(spec.kind)) name.append("_").append(general(spec.relaxation_time_s, 4));
  if (has_parts(spec.kind)) {
    const auto constant = [&](const FeaturePart& part) {
      return general(spec.kind == FeatureKind::stops ? 1e3 * part.threshold_m : part.relaxation_time_s, 4);
    };
    name.append("_").append(constant(spec.parts[0]));
    if (spec.part_count > 1) name.append("-").append(constant(spec.parts[spec.part_count - 1]));
  }
  return name.append(facts_of(spec.kind).unit);
}

FeatureFilter::FeatureFilter(const std::vector<FeatureSpec>& specs)
    : surface_position_m_(surface_position_m(specs)), count_(std::min(specs.size(), kMaxFeatures)) {
  assert(!specs.empty() && specs.size() <= kMaxFeatures);
  std::copy_n(specs.begin(), count_, specs_.begin());
  for (std::size_t i = 0; i < count_; ++i) {
    const FeatureSpec& spec = specs_[i];
    if (spec.kind == FeatureKind::surface_lag) lag_ = i;
    slows_ = slows_ || (is_branch(spec.kind) && spec.slowing != 0.0);
    for (std::size_t p = 0; p < lane_count(spec); ++p) {
      const bool creeps = spec.kind == FeatureKind::creep;
      const std::size_t place = is_branch(spec.kind) ? branches_.add(branch_drive(spec, p), branch_time_s(spec, p))
                                                     : bristles_.add(spec.parts[p].drive, spec.parts[p].threshold_m,
                                                                     creeps ? spec.parts[p].relaxation_time_s : 0.0);
      if (p == 0) place_[i] = place;
    }
  }
}

const FeatureVector& FeatureFilter::update(const ToolSample& sample, const MotionEstimate& motion) noexcept {
  const double depth_m = std::max(0.0, motion.position_m - surface_position_m_);
  vector_.depth_m = std::max(0.0, sample.position_m - surface_position_m_);
  vector_.in_contact = sample.position_m > surface_position_m_;
  const double step_s = sample.time_s - time_s_;
  const bool advance = started_ && step_s > 0.0;
  if (advance) prepare_branches(depth_m, step_s);
  const double surface_m = advance && lag_ < count_ ? surface_above_m(depth_m) : depth_m;
  advance_parts(depth_m, surface_m, advance ? step_s : 0.0);
  for (std::size_t i = 0; i < count_; ++i) {
    const FeatureSpec& spec = specs_[i];
    double& value = vector_.values[i];
    switch (spec.kind) {
      case FeatureKind::depth:
        value = depth_m;
        break;
      case FeatureKind::velocity:
        value = depth_m > 0.0 ? motion.velocity_m_per_s : 0.0;
        break;
      case FeatureKind::lowpass_velocity:
        if (advance) {
          const double keep = std::exp(-step_s / spec.relaxation_time_s);
          value = keep * value + (1.0 - keep) * (depth_m - depth_m_) / step_s;
          // A filter at rest decays to zero, not into denormals, which would
          // slow every later operation on it.
          if (std::abs(value) < 1e-30) value = 0.0;
        } else if (!started_) {
          value = 0.0;
        }
        break;
      case FeatureKind::maxwell_branch:
      case FeatureKind::maxwell_spectrum:
        value = branches_.force_N(place_[i], lane_count(spec));
        break;
      case FeatureKind::surface_lag:
        value = surface_m - depth_m;
        break;
      case FeatureKind::stops:
      case FeatureKind::creep:
        value = bristles_.force_N(place_[i], lane_count(spec));
        break;
    }
  }
  started_ = true;
  time_s_ = sample.time_s;
  depth_m_ = depth_m;
  surface_m_ = surface_m;
  return vector_;
}

void FeatureFilter::prepare_branches(double depth_m, double step_s) noexcept {
  if (branches_.empty()) return;
  const double halfway_m = surface_halfway(surface_m_, depth_m_, depth_m);
  for (std::size_t i = 0; slows_ && i < count_; ++i) {
    const FeatureSpec& spec = specs_[i];
    if (!is_branch(spec.kind)) continue;
    const double clock = branch_clock(spec.slowing, halfway_m, branch_drive(spec, 0).reference_depth_m);
    for (std::size_t p = 0; p < lane_count(spec); ++p) branches_.set_clock(place_[i] + p, clock);
  }
  branches_.prepare(step_s);
}

// What elastic response and branches would hold with the surface there.
double FeatureFilter::held_N(double surface_m) noexcept {
  return specs_[lag_].drive.at(surface_m) + branches_.held_N(surface_m);
}

// Regula falsi with halving (Dowell & Jarratt 1971): the surface of before holds
// nothing or pushes, since what pulls in it decays.
double FeatureFilter::surface_above_m(double depth_m) noexcept {
  double low_N = held_N(depth_m);
  if (low_N >= 0.0) return depth_m;
  double low_m = depth_m;
  double high_m = surface_m_;
  if (!(high_m - low_m > kNoLag_m)) return depth_m;
  double high_N = held_N(high_m);
  if (!(high_N > 0.0)) return high_m;
  double middle_m = high_m;
  for (int step = 0; step < kSurfaceSteps; ++step) {
    middle_m = low_m - low_N * (high_m - low_m) / (high_N - low_N);
    const double middle_N = held_N(middle_m);
    if (std::abs(middle_N) < kSurfaceForce_N) break;
    if (middle_N > 0.0) {
      high_m = middle_m;
      high_N = middle_N;
      low_N *= 0.5;
    } else {
      low_m = middle_m;
      low_N = middle_N;
      high_N *= 0.5;
    }
  }
  return middle_m;
}

// `step_s`: 0 for no step.
void FeatureFilter::advance_parts(double depth_m, double surface_m, double step_s) noexcept {
  if (!branches_.empty()) {
    if (step_s > 0.0) {
      branches_.advance(surface_m);
    } else {
      branches_.stay(surface_m, !started_);
    }
  }
  if (bristles_.empty()) return;
  if (!started_) bristles_.release();
  if (step_s > 0.0) {
    bristles_.advance(depth_m_, depth_m, step_s);
  } else {
    bristles_.stay(depth_m);
  }
}

void FeatureFilter::adopt(const FeatureFilter& before) noexcept {
  if (before.surface_position_m_ != surface_position_m_) return;
  for (std::size_t i = 0; i < count_; ++i) {
    for (std::size_t k = 0; k < before.count_; ++k) {
      if (specs_[i].kind == before.specs_[k].kind) adopt_feature(i, before, k);
    }
  }
}

void FeatureFilter::adopt_feature(std::size_t index, const FeatureFilter& before, std::size_t other) noexcept {
  const FeatureSpec& spec = specs_[index];
  const FeatureSpec& old = before.specs_[other];
  if (is_bristle(spec.kind)) {
    for (std::size_t p = 0; p < spec.part_count; ++p) {
      for (std::size_t q = 0; q < old.part_count; ++q) {
        if (spec.parts[p].threshold_m != old.parts[q].threshold_m) continue;
        if (spec.parts[p].relaxation_time_s != old.parts[q].relaxation_time_s) continue;
        bristles_.adopt(place_[index] + p, before.bristles_, before.place_[other] + q);
      }
    }
    bristles_.stay(depth_m_);
    vector_.values[index] = bristles_.force_N(place_[index], spec.part_count);
  } else if (spec == old) {
    vector_.values[index] = before.vector_.values[other];
    if (index == lag_) surface_m_ = before.surface_m_;
    for (std::size_t p = 0; is_branch(spec.kind) && p < lane_count(spec); ++p) {
      branches_.adopt(place_[index] + p, before.branches_, before.place_[other] + p);
    }
  }
}

}  // namespace palpate
