#include "devices/hid/hid_bus.h"

#include <array>
#include <string>
#include <utility>

#include "devices/hid/hid_drivers.h"

namespace palpate {
namespace {

// Reports to judge by; at 1 kHz they come at once.
constexpr int kReportsToInspect = 8;
// Reads that may come back with nothing.
constexpr int kMostEmptyReads = 10;

// What to install on a device that one of `drivers` should understand.
std::string install(const HidDrivers& drivers) {
  const std::string firmware = drivers.front()->firmware;
  return firmware.empty() ? "install its firmware anew" : "install " + firmware;
}

// What a device sent while it was identified.
struct Identification {
  int reports = 0;
  int last_size = 0;
  bool unplugged = false;
  std::array<int, kHidDrivers.size()> understood{};  // as `drivers`
  const HidDriver* other_version = nullptr;
  int version = 0;  // of it
};

Identification read_reports(HidConnection& connection, const HidDrivers& drivers) {
  Identification seen;
  for (int empty = 0; seen.reports < kReportsToInspect && empty < kMostEmptyReads;) {
    std::array<std::uint8_t, kLargestHidReport + 1> bytes{};
    seen.last_size = connection.read(bytes.data(), bytes.size());
    seen.unplugged = seen.last_size < 0;
    if (seen.unplugged) return seen;
    if (seen.last_size == 0) {
      ++empty;
      continue;
    }
    ++seen.reports;
    for (std::size_t i = 0; i < drivers.size(); ++i) {
      DeviceReading reading;
      const ReportVerdict verdict =
          drivers[i]->decode(bytes.data(), static_cast<std::size_t>(seen.last_size), reading);
      if (verdict == ReportVerdict::position) ++seen.understood[i];
      if (verdict != ReportVerdict::wrong_version) continue;
      seen.other_version = drivers[i];
      seen.version = reading.version;
    }
  }
  return seen;
}

}  // namespace

HidDrivers matching_drivers(const HidDeviceInfo& info) {
  HidDrivers drivers;
  for (const HidDriver* driver : kHidDrivers) {
    if (driver->matches(info)) drivers.push_back(driver);
  }
  return drivers;
}

Result<const HidDriver*> identify(HidConnection& connection, const HidDrivers& drivers) {
  // Silent until it is asked, or until it is touched: its ids must do.
  if (drivers.size() == 1 && !drivers.front()->reports_unasked) return drivers.front();
  const Identification seen = read_reports(connection, drivers);
  if (seen.unplugged) return Error{"was unplugged while it was opened; plug it in again"};
  if (seen.reports == 0)
    return Error{"sends no reports; is its firmware running? reset it or " + install(drivers)};
  for (std::size_t i = 0; i < drivers.size(); ++i) {
    if (2 * seen.understood[i] > seen.reports) return drivers[i];
  }
  if (const HidDriver* other = seen.other_version) {
    return Error{"wrong firmware: speaks version " + std::to_string(seen.version) + " of the " + other->name +
                 " protocol, expected " + std::to_string(other->version) + "; " + install(drivers)};
  }
  if (seen.last_size != static_cast<int>(kLargestHidReport)) {
    return Error{"wrong report size: found " + std::to_string(seen.last_size) + " bytes, expected " +
                 std::to_string(kLargestHidReport) + "; its firmware is another one, " + install(drivers)};
  }
  return Error{"its reports are none that this program knows; " + install(drivers)};
}

std::vector<HidDiagnosis> diagnose(HidBus& bus) {
  std::vector<HidDiagnosis> all;
  for (const HidDeviceInfo& info : bus.list()) {
    HidDiagnosis diagnosis{info, nullptr, "none that this program uses", ""};
    const HidDrivers drivers = matching_drivers(info);
    if (!drivers.empty()) {
      diagnosis.use.clear();
      for (const HidDriver* driver : drivers) {
        diagnosis.use += (diagnosis.use.empty() ? "" : " or ") + std::string(driver->description);
      }
      Result<std::unique_ptr<HidConnection>> connection = bus.open(info);
      if (!connection) {
        diagnosis.problem = connection.error().message;
      } else if (const Result<const HidDriver*> driver = identify(**connection, drivers); !driver) {
        diagnosis.problem = info.path + ": " + driver.error().message;
      } else {
        diagnosis.driver = *driver;
        diagnosis.use = (*driver)->description;
      }
    }
    all.push_back(std::move(diagnosis));
  }
  return all;
}

}  // namespace palpate
