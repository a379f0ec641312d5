#include "engine/tick/features.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/base/text.h"

namespace palpate {
double surface_position_m(const std::vector<FeatureSpec>& specs) noexcept {
  for (const FeatureSpec& spec : specs)
    if (spec.kind == FeatureKind::depth) return spec.surface_position_m;
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

std::vector<FeaturePart> parts_of(const FeatureSpec& spec) {
  if (spec.kind == FeatureKind::lowpass_velocity)
    return {{spec.relaxation_time_s, 0.0, DriveCurve{1.0, {1.0 / spec.relaxation_time_s}}}};
  return {spec.parts.begin(), spec.parts.begin() + static_cast<std::ptrdiff_t>(spec.part_count)};
}

std::size_t memory_size(const std::vector<FeatureSpec>& specs) noexcept {
  std::size_t size = 0;
  for (const FeatureSpec& spec : specs) size += has_time(spec.kind) ? 1 : spec.part_count;
  return size;
}

FeaturePlan::FeaturePlan(const std::vector<FeatureSpec>& specs, double deepest_m,
                         const std::vector<RecordingEnds>& ends)
    : specs_(specs), ends_(ends), surface_position_m_(palpate::surface_position_m(specs)), deepest_m_(deepest_m) {
  assert(!specs.empty() && specs.size() <= kMaxFeatures);
  for (std::size_t i = 0; i < specs_.size(); ++i) {
    const FeatureSpec& spec = specs_[i];
    const double slowing_depth_m = spec.parts[0].drive.reference_depth_m;
    for (const FeaturePart& part : parts_of(spec)) {
      const double creep_time_s = spec.kind == FeatureKind::creep ? part.relaxation_time_s : 0.0;
      const std::size_t lane = is_bristle(spec.kind)
                                   ? bristles_.add(part.drive, part.threshold_m, creep_time_s)
                                   : branches_.add(part.drive, part.relaxation_time_s, spec.slowing, slowing_depth_m);
      if (lanes_[i]++ == 0) first_lane_[i] = lane;
    }
  }
  for (std::size_t i = 0; i < specs_.size(); ++i)
    if (is_bristle(specs_[i].kind)) first_lane_[i] += kLanes * branches_.groups();
}

void FeaturePlan::each_memory(FeatureState& state, const auto& use) const {
  for (std::size_t i = 0; i < specs_.size(); ++i) {
    for (std::size_t lane = first_lane_[i]; lane < first_lane_[i] + lanes_[i]; ++lane) {
      V4& group = state.memory.value[lane / kLanes];
      group[lane % kLanes] = use(group[lane % kLanes]);
    }
  }
}

std::vector<double> FeaturePlan::memory_of(const FeatureState& state) const {
  std::vector<double> memory;
  FeatureState same = state;
  each_memory(same, [&](double value) {
    memory.push_back(value);
    return value;
  });
  return memory;
}

void FeaturePlan::begin(FeatureState& state, const ToolSample& sample) const noexcept {
  state = {};
  if (!in_contact(sample, surface_position_m_)) return;
  double nearest_end_m = std::numeric_limits<double>::infinity(), nearest_beginning_m = nearest_end_m;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    nearest_beginning_m = std::min(nearest_beginning_m, std::abs(sample.position_m - ends_[i].first_position_m));
    const double away_m = std::abs(sample.position_m - ends_[i].last_position_m);
    if (!(away_m < nearest_end_m)) continue;
    nearest_end_m = away_m;
    state.began = static_cast<int>(i);
  }
  if (!(nearest_end_m < nearest_beginning_m)) {
    state.began = kBeganAtRest;
    return;
  }
  auto value = ends_[static_cast<std::size_t>(state.began)].memory.begin();
  each_memory(state, [&](double) { return *value++; });
  // Nothing happens between that end and this sample.
  state.started = true;
  state.time_s = sample.time_s;
}

void FeaturePlan::update(FeatureState& state, const ToolSample& sample, const MotionEstimate& motion) const noexcept {
  const double present_m = std::max(0.0, motion.position_m - surface_position_m_);
  const double depth_m = std::min(present_m, deepest_m_);  // remembered
  if (!state.started) state = {};
  state.vector.in_contact = in_contact(sample, surface_position_m_);
  const double step_s = state.started ? std::max(0.0, sample.time_s - state.time_s) : 0.0;
  PartMemory& memory = state.memory;
  const std::size_t branches = branches_.groups();
  // The bristles first: their roots and quotients take long, and the branches do not wait for them.
  bristles_.advance(state.depth_m, depth_m, step_s, memory.value + branches, memory.drive_N + branches);
  branches_.advance(state.depth_m, depth_m, step_s, memory);
  const std::size_t features = specs_.size(), branch_lanes = kLanes * branches;
  for (std::size_t i = 0; i < features; ++i) {
    double& value = state.vector.values[i];
    if (lanes_[i] > 0)
      value = sum_of_lanes(first_lane_[i] < branch_lanes ? memory.value : memory.drive_N, first_lane_[i], lanes_[i]);
    else
      value = specs_[i].kind == FeatureKind::depth ? present_m : depth_m > 0.0 ? motion.velocity_m_per_s : 0.0;
  }
  state.started = true;
  state.time_s = sample.time_s;
  state.depth_m = depth_m;
}

void FeaturePlan::adopt(FeatureState& state, const FeaturePlan& plan, const FeatureState& before) const noexcept {
  if (plan.surface_position_m_ != surface_position_m_) return;
  for (std::size_t i = 0; i < specs_.size(); ++i) {
    for (std::size_t k = 0; k < plan.specs_.size(); ++k) {
      if (specs_[i] != plan.specs_[k]) continue;
      state.vector.values[i] = before.vector.values[k];
      for (std::size_t p = 0; p < lanes_[i]; ++p) {
        const std::size_t lane = first_lane_[i] + p, old = plan.first_lane_[k] + p;
        const auto copy = [&](V4* to, const V4* from) {
          to[lane / kLanes][lane % kLanes] = from[old / kLanes][old % kLanes];
        };
        copy(state.memory.value, before.memory.value);
        copy(state.memory.drive_N, before.memory.drive_N);
      }
    }
  }
}

}  // namespace palpate
