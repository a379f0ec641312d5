#include "devices/hid/hid_bus.h"

#include <utility>

#include "devices/hid/hid_drivers.h"

namespace palpate {
const HidDriver* matching_driver(const HidDeviceInfo& info) {
  for (const HidDriver* driver : kHidDrivers) {
    if (driver->matches(info)) return driver;
  }
  return nullptr;
}

std::vector<HidDiagnosis> diagnose(HidBus& bus) {
  std::vector<HidDiagnosis> all;
  for (const HidDeviceInfo& info : bus.list()) {
    HidDiagnosis diagnosis{info, nullptr, "none that this program uses", ""};
    if (const HidDriver* const driver = matching_driver(info)) {
      diagnosis.use = driver->description;
      Result<std::unique_ptr<HidConnection>> connection = bus.open(info);
      if (!connection) {
        diagnosis.problem = connection.error().message;
      } else {
        diagnosis.driver = driver;
      }
    }
    all.push_back(std::move(diagnosis));
  }
  return all;
}

}  // namespace palpate
