// Models and devices for tests of the loop: springs, and a tool that follows a
// function of time.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/live/device.h"
#include "engine/live/live_tick.h"
#include "engine/live/pacer.h"
#include "engine/tick/force_model.h"

namespace palpate::test {

class NamedModel : public ForceModel {
 public:
  const std::vector<FeatureSpec>& features() const noexcept override { return features_; }
  const std::string& name() const noexcept override { return name_; }
  const std::string& method() const noexcept override { return name_; }
  int centre_count() const noexcept override { return 0; }
  void assess(const double*, ForceEstimate&) const noexcept override {}

 protected:
  explicit NamedModel(std::string name, std::vector<FeatureSpec> features = {FeatureSpec{}})
      : features_(std::move(features)), name_(std::move(name)) {}

 private:
  std::vector<FeatureSpec> features_;
  std::string name_;
};

// F = stiffness x depth. By default, depth is its only feature.
class SpringModel final : public NamedModel {
 public:
  explicit SpringModel(double stiffness_N_per_m, std::vector<FeatureSpec> features = {FeatureSpec{}})
      : NamedModel("spring", std::move(features)), stiffness_N_per_m_(stiffness_N_per_m) {}
  double force(const double* features) const noexcept override { return stiffness_N_per_m_ * features[0]; }

 private:
  double stiffness_N_per_m_;
};

inline std::shared_ptr<const ForceModel> spring(double stiffness_N_per_m) {
  return std::make_shared<const SpringModel>(stiffness_N_per_m);
}

// Returns 0 N and counts its evaluations.
class CountingModel final : public NamedModel {
 public:
  CountingModel() : NamedModel("counting") {}
  double force(const double*) const noexcept override {
    ++evaluations_;
    return 0.0;
  }
  std::uint64_t evaluations() const { return evaluations_; }

 private:
  mutable std::atomic<std::uint64_t> evaluations_ = 0;
};

// Returns one sample per tick, at the position `path(time)`. `state` is its health, `force_age` that of each sample; a
// `silent` device has no samples.
class PathDevice final : public Device {
 public:
  using Path = double (*)(double time_s);
  explicit PathDevice(Path path, const ForceLimits& limits = {1e3, 1e9, 0.0}) : path_(path), limits_(limits) {}

  const std::string& name() const noexcept override { return name_; }
  SensorSpec sensor() const noexcept override { return {0.0, 1e-6}; }
  Holder holder() const noexcept override { return Holder::person; }
  ForceLimits limits() const noexcept override { return limits_; }
  bool read(double now_s, DeviceSample& sample) noexcept override {
    if (silent || now_s == now_s_) return false;
    now_s_ = now_s;
    sample = {};
    sample.tool.time_s = now_s;
    sample.tool.position_m = path_(now_s);
    sample.force_age = force_age;
    return true;
  }
  DeviceHealth health(double) noexcept override { return state; }
  void write(double force_N) noexcept override {
    force_N_ = force_N;
    ++writes_;
  }

  double force_N() const { return force_N_; }
  int writes() const { return writes_; }
  DeviceHealth state;
  ForceAge force_age;
  bool silent = false;

 private:
  Path path_;
  ForceLimits limits_;
  std::string name_ = "path";
  double now_s_ = -1.0;
  double force_N_ = 0.0;
  int writes_ = 0;
};

// A live tick of a device, called every simulated millisecond.
class LiveRig {
 public:
  explicit LiveRig(Device& device, const LiveTickSettings& settings = {})
      : device_(device), live_(device, slot_, settings) {}

  LiveTick& live() { return live_; }
  ModelSlot<LiveModels>& slot() { return slot_; }
  void publish(std::uint32_t id, const ForceModels& models, std::shared_ptr<ReferenceForce> reference = nullptr) {
    slot_.publish(std::make_unique<LiveModels>(id, device_.sensor(), models, std::move(reference)));
  }
  // The snapshot of the last of `ticks` ticks.
  const LoopSnapshot& run(int ticks = 1, const LoopControls& controls = {}) {
    for (int i = 1; i < ticks; ++i) live_.run(kHapticTick_s * tick_++, controls);
    return live_.run(kHapticTick_s * tick_++, controls);
  }
  double next_s() const { return kHapticTick_s * tick_; }

 private:
  Device& device_;
  ModelSlot<LiveModels> slot_;
  LiveTick live_;
  int tick_ = 0;
};

inline double held_5mm(double) { return 5e-3; }
inline double strokes(double time_s) { return 4e-3 * std::sin(6.0 * time_s); }

// A simulated clock that advances only during waits. Wait number n ends
// `lateness_ns(n)` after its deadline.
class FakePacer final : public Pacer {
 public:
  explicit FakePacer(std::function<std::int64_t(int)> lateness_ns) : lateness_ns_(std::move(lateness_ns)) {}
  std::int64_t now_ns() noexcept override { return now_ns_; }
  void wait_until(std::int64_t deadline_ns) noexcept override {
    now_ns_ = std::max(now_ns_, deadline_ns + lateness_ns_(waits_++));
  }
  int waits() const { return waits_; }

 private:
  std::function<std::int64_t(int)> lateness_ns_;
  std::int64_t now_ns_ = 1'000'000'000;
  int waits_ = 0;
};

}  // namespace palpate::test
