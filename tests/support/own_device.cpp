// The second of the three files of a new device.
#include "tests/support/own_device.h"

#include <cmath>
#include <cstdlib>

namespace palpate::test {

bool OwnDevice::read(double now_s, DeviceSample& sample) noexcept {
  if (now_s == read_s_) return false;
  read_s_ = now_s;
  sample = {};
  sample.tool = {now_s, stroke_m_ * std::sin(6.0 * now_s)};
  return true;
}

MadeDevice make_own_device(const std::string& stroke_mm, const DeviceRequest&) {
  const double stroke_m = 1e-3 * std::strtod(stroke_mm.c_str(), nullptr);
  if (!(stroke_m > 0.0)) return Error{"--device own: found \"" + stroke_mm + "\", expected own:MILLIMETRES"};
  return MadeDevice(std::make_unique<OwnDevice>(stroke_m));
}

}  // namespace palpate::test
