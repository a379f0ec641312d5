// 3Dconnexion's SpaceMouse: report 1 begins with three int16 translations. z is used; it is positive when the cap is
// pushed down. The host writes no reports.
#include <algorithm>
#include <cstdlib>

#include "devices/firmware/wire.h"
#include "devices/hid/hidapi_bus.h"

namespace palpate {
namespace {

constexpr std::uint16_t k3Dconnexion = 0x256F, kLogitech = 0x046D;
// Product ids with Logitech's vendor id; later products have the vendor id of 3Dconnexion.
constexpr std::array<std::uint16_t, 7> kSpaceMice = {0xC626, 0xC627, 0xC628, 0xC629, 0xC62B, 0xC62E, 0xC62F};
constexpr std::uint16_t kDesktopPage = 1, kMultiAxis = 8;
// Larger values are invalid; every deflection is far below.
constexpr int kSpaceMouseMost = 1000;

bool is_space_mouse(const DeviceNode& info) noexcept {
  if (info.usage_page != kDesktopPage || info.usage != kMultiAxis) return false;
  return info.vendor_id == k3Dconnexion ||
         (info.vendor_id == kLogitech &&
          std::find(kSpaceMice.begin(), kSpaceMice.end(), info.product_id) != kSpaceMice.end());
}

ReportVerdict decode_space_mouse(const std::uint8_t* bytes, std::size_t size, DeviceReading& reading) noexcept {
  if (size == 0) return ReportVerdict::corrupt;
  if (bytes[0] != 1) return ReportVerdict::nothing;  // rotation, buttons, battery
  if (size < 7) return ReportVerdict::corrupt;
  for (const std::size_t at : {1u, 3u, 5u})
    if (std::abs(static_cast<std::int16_t>(wire::read16(bytes + at))) > kSpaceMouseMost) return ReportVerdict::corrupt;
  reading.counts = static_cast<std::int16_t>(wire::read16(bytes + 5));
  return ReportVerdict::position;
}

}  // namespace

const DeviceProtocol kSpaceMouseProtocol = {
    .name = "spacemouse",
    .description = "SpaceMouse, input only: no force",
    .matches = is_space_mouse,
    .decode = decode_space_mouse,
};

}  // namespace palpate
