#include "engine/tick/features.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>

namespace palpate {
namespace {

constexpr int kSurfaceSteps = 6;
constexpr double kSurfaceForce_N = 1e-5;
// Nearer than this, below an atom, the surface has come back.
constexpr double kNoLag_m = 1e-12;

// A branch alone is a spectrum of one.
std::size_t branch_count(const FeatureSpec& spec) noexcept {
  return spec.kind == FeatureKind::maxwell_branch ? 1 : spec.part_count;
}
const DriveCurve& branch_drive(const FeatureSpec& spec, std::size_t part) noexcept {
  return spec.kind == FeatureKind::maxwell_branch ? spec.drive : spec.parts[part].drive;
}
double branch_time_s(const FeatureSpec& spec, std::size_t part) noexcept {
  return spec.kind == FeatureKind::maxwell_branch ? spec.relaxation_time_s : spec.parts[part].relaxation_time_s;
}

std::string four_digits(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, std::chars_format::general, 4);
  return {buffer.data(), end.ptr};
}

}  // namespace

KnotSum knot_sum(const std::array<double, kDriveKnots>& knot_N, double u) noexcept {
  KnotSum sum;
  for (std::size_t k = 0; k < kDriveKnots; ++k) {
    const double beyond = std::max(0.0, u - static_cast<double>(k + 1) / (kDriveKnots + 1));
    const double square = knot_N[k] * beyond * beyond;
    sum.value_N += square * beyond;
    sum.slope_N += 3.0 * square;
  }
  return sum;
}

double DriveCurve::at(double depth_m) const noexcept {
  const double u = depth_m / reference_depth_m;
  const double inside = std::min(u, 1.0);
  double value = 0.0;
  double slope = 0.0;
  for (std::size_t k = kDriveCoefficients; k-- > 0;) {
    slope = slope * inside + static_cast<double>(k + 1) * coefficient_N[k];
    value = (value + coefficient_N[k]) * inside;
  }
  if (has_knots) {
    const KnotSum knots = knot_sum(knot_N, inside);
    value += knots.value_N;
    slope += knots.slope_N;
  }
  return u > 1.0 ? value + slope * (u - 1.0) : value;
}

BranchStep branch_step(double relaxation_time_s, double step_s) noexcept {
  const double keep = std::exp(-step_s / relaxation_time_s);
  return {keep, relaxation_time_s * (1.0 - keep) / step_s};
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

std::string_view feature_kind_name(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::depth: return "depth";
    case FeatureKind::velocity: return "velocity";
    case FeatureKind::lowpass_velocity: return "lowpass_velocity";
    case FeatureKind::maxwell_branch: return "maxwell_branch";
    case FeatureKind::maxwell_spectrum: return "maxwell_spectrum";
    case FeatureKind::stops: return "stops";
    case FeatureKind::fading_peak: return "fading_peak";
    case FeatureKind::surface_lag: return "surface_lag";
  }
  return "depth";
}

std::string feature_name(const FeatureSpec& spec) {
  const auto first_to_last = [&](auto&& constant) {
    const std::string first = four_digits(constant(spec.parts[0]));
    if (spec.part_count <= 1) return first;
    return first + "-" + four_digits(constant(spec.parts[spec.part_count - 1]));
  };
  const std::string time = four_digits(spec.relaxation_time_s);
  switch (spec.kind) {
    case FeatureKind::depth: return "feature_depth_m";
    case FeatureKind::velocity: return "feature_velocity_m_per_s";
    case FeatureKind::lowpass_velocity: return "feature_lowpass_velocity_" + time + "s_m_per_s";
    case FeatureKind::maxwell_branch: return "feature_maxwell_branch_" + time + "s_N";
    case FeatureKind::maxwell_spectrum:
      return "feature_maxwell_spectrum_" + first_to_last([](const FeaturePart& part) { return part.relaxation_time_s; }) +
             "s_N";
    case FeatureKind::stops:
      return "feature_stops_" + first_to_last([](const FeaturePart& part) { return 1e3 * part.threshold_m; }) + "mm_N";
    case FeatureKind::fading_peak: return "feature_fading_peak_" + time + "s_m";
    case FeatureKind::surface_lag: return "feature_surface_lag_m";
  }
  return {};
}

FeatureFilter::FeatureFilter(const std::vector<FeatureSpec>& specs)
    : surface_position_m_(surface_position_m(specs)), count_(std::min(specs.size(), kMaxFeatures)) {
  assert(!specs.empty() && specs.size() <= kMaxFeatures);
  std::copy_n(specs.begin(), count_, specs_.begin());
  for (std::size_t i = 0; i < count_; ++i) {
    if (specs_[i].kind == FeatureKind::surface_lag) lag_ = i;
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
          value = keep * value + (1.0 - keep) * (depth_m - drive_[i]) / step_s;
          // A filter at rest decays to zero, not into denormals, which would
          // slow every later operation on it.
          if (std::abs(value) < 1e-30) value = 0.0;
        } else if (!started_) {
          value = 0.0;
        }
        drive_[i] = depth_m;
        break;
      case FeatureKind::maxwell_branch:
      case FeatureKind::maxwell_spectrum:
        value = updated_branches(i, surface_m, advance);
        break;
      case FeatureKind::surface_lag:
        value = surface_m - depth_m;
        break;
      case FeatureKind::stops:
        value = updated_stops(i, depth_m, advance);
        break;
      case FeatureKind::fading_peak:
        if (advance) {
          value = std::max(depth_m, depth_m_ + (value - depth_m_) * std::exp(-step_s / spec.relaxation_time_s));
          // Healed, to far below an atom.
          if (value < 1e-15) value = 0.0;
        } else if (!started_) {
          value = depth_m;
        }
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
  const double halfway_m = surface_halfway(surface_m_, depth_m_, depth_m);
  for (std::size_t i = 0; i < count_; ++i) {
    const FeatureSpec& spec = specs_[i];
    if (!is_branch(spec.kind)) continue;
    const double clock = branch_clock(spec.slowing, halfway_m, branch_drive(spec, 0).reference_depth_m);
    for (std::size_t p = 0; p < branch_count(spec); ++p) {
      step_[i][p] = branch_step(clock * branch_time_s(spec, p), step_s);
    }
  }
}

// What elastic response and branches would hold with the surface there.
double FeatureFilter::held_N(double surface_m) noexcept {
  double force_N = specs_[lag_].drive.at(surface_m);
  for (std::size_t i = 0; i < count_; ++i) {
    if (!is_branch(specs_[i].kind)) continue;
    for (std::size_t p = 0; p < branch_count(specs_[i]); ++p) {
      const BranchStep& step = step_[i][p];
      const double drive = branch_drive(specs_[i], p).at(surface_m);
      force_N += step.keep * part_state_[i][p] + step.gain * (drive - part_drive_[i][p]);
    }
  }
  return force_N;
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

double FeatureFilter::updated_branches(std::size_t index, double surface_m, bool advance) noexcept {
  const FeatureSpec& spec = specs_[index];
  double sum = 0.0;
  for (std::size_t p = 0; p < branch_count(spec); ++p) {
    const double drive = branch_drive(spec, p).at(surface_m);
    double& z = part_state_[index][p];
    if (advance) {
      const BranchStep& step = step_[index][p];
      z = step.keep * z + step.gain * (drive - part_drive_[index][p]);
      if (std::abs(z) < 1e-30) z = 0.0;
    } else if (!started_) {
      z = 0.0;
    }
    part_drive_[index][p] = drive;
    sum += z;
  }
  return sum;
}

double FeatureFilter::updated_stops(std::size_t index, double depth_m, bool advance) noexcept {
  const FeatureSpec& spec = specs_[index];
  double sum = 0.0;
  for (std::size_t p = 0; p < spec.part_count; ++p) {
    const double threshold_m = spec.parts[p].threshold_m;
    double& s = part_state_[index][p];
    if (!started_ || !(depth_m > 0.0)) {
      s = 0.0;
    } else if (advance) {
      s = std::clamp(s + depth_m - depth_m_, -threshold_m, threshold_m);
    }
    sum += spec.parts[p].drive.at(depth_m) * s / threshold_m;
  }
  return sum;
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
  if (specs_[index] == before.specs_[other]) {
    vector_.values[index] = before.vector_.values[other];
    if (index == lag_) surface_m_ = before.surface_m_;
    drive_[index] = before.drive_[other];
    part_drive_[index] = before.part_drive_[other];
    part_state_[index] = before.part_state_[other];
  } else if (specs_[index].kind == FeatureKind::stops) {
    for (std::size_t p = 0; p < specs_[index].part_count; ++p) {
      for (std::size_t q = 0; q < before.specs_[other].part_count; ++q) {
        if (specs_[index].parts[p].threshold_m == before.specs_[other].parts[q].threshold_m) {
          part_state_[index][p] = before.part_state_[other][q];
        }
      }
    }
    vector_.values[index] = updated_stops(index, depth_m_, false);
  }
}

}  // namespace palpate
