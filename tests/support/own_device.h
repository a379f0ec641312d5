// An example of a new device: a class of six functions. The tool is moved in and out by a motor.
#pragma once

#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>

#include "devices/registry/device_registry.h"

namespace palpate::test {

class OwnDevice final : public Device {
 public:
  explicit OwnDevice(double stroke_m) : stroke_m_(stroke_m) {}

  const std::string& name() const noexcept override { return name_; }
  SensorSpec sensor() const noexcept override { return {.encoder_step_m = 1e-6}; }
  Holder holder() const noexcept override { return Holder::person; }
  ForceLimits limits() const noexcept override { return {5.0, 2000.0, 0.05}; }
  bool read(double now_s, DeviceSample& sample) noexcept override {
    if (now_s == read_s_) return false;
    read_s_ = now_s;
    sample = {};
    sample.tool = {now_s, stroke_m_ * std::sin(6.0 * now_s)};
    return true;
  }
  void write(double force_N) noexcept override { force_N_ = force_N; }

  double force_N() const noexcept { return force_N_; }

 private:
  std::string name_ = "own";
  double stroke_m_;
  double force_N_ = 0.0;
  double read_s_ = -1.0;
};

// The factory for its row in the table of devices.
inline MadeDevice make_own_device(const std::string& stroke_mm, const DeviceRequest&) {
  const double stroke_m = 1e-3 * std::strtod(stroke_mm.c_str(), nullptr);
  if (!(stroke_m > 0.0)) return Error{"--device own: found \"" + stroke_mm + "\", expected own:MILLIMETRES"};
  return MadeDevice(std::make_unique<OwnDevice>(stroke_m));
}

}  // namespace palpate::test
