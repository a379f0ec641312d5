#include "devices/hid/hid_driver.h"

#include <algorithm>
#include <cmath>

namespace palpate {

std::int16_t int16_units(const HidCommand& command) noexcept {
  if (!command.drive || !std::isfinite(command.units)) return 0;
  return static_cast<std::int16_t>(std::lround(std::clamp(command.units, -32767.0, 32767.0)));
}

std::uint8_t* append_report(OutReports& reports, std::uint8_t id, std::size_t size) noexcept {
  std::uint8_t* bytes = reports.bytes[reports.count].data();
  bytes[0] = id;
  reports.sizes[reports.count] = size + 1;
  ++reports.count;
  return bytes + 1;
}

}  // namespace palpate
