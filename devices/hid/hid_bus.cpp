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

// The advice for a device that does not speak as `driver` does, with what following it costs.
std::string install(const HidDriver& driver) {
  const std::string firmware = driver.firmware;
  if (firmware.empty()) return "install its firmware anew";
  return "if it is a " + std::string(driver.description) + ", install " + firmware +
         " (it replaces what is on the board)";
}

// What a device sent while it was identified.
struct Identification {
  int reports = 0;
  int understood = 0;
  bool unplugged = false;
  int other_version = 0;  // 0: none
};

Identification read_reports(HidConnection& connection, const HidDriver& driver) {
  Identification seen;
  for (int empty = 0; seen.reports < kReportsToInspect && empty < kMostEmptyReads;) {
    std::array<std::uint8_t, kLargestHidReport + 1> bytes{};
    const int size = connection.read(bytes.data(), bytes.size());
    seen.unplugged = size < 0;
    if (seen.unplugged) return seen;
    if (size == 0) {
      ++empty;
      continue;
    }
    ++seen.reports;
    DeviceReading reading;
    const ReportVerdict verdict = driver.decode(bytes.data(), static_cast<std::size_t>(size), reading);
    if (verdict == ReportVerdict::position) ++seen.understood;
    if (verdict == ReportVerdict::wrong_version) seen.other_version = reading.version;
  }
  return seen;
}

}  // namespace

const HidDriver* matching_driver(const HidDeviceInfo& info) {
  for (const HidDriver* driver : kHidDrivers) {
    if (driver->matches(info)) return driver;
  }
  return nullptr;
}

Status identify(HidConnection& connection, const HidDriver& driver) {
  // Silent until it is asked, or until it is touched: its ids must do.
  if (!driver.reports_unasked) return {};
  const Identification seen = read_reports(connection, driver);
  if (seen.unplugged) return Error{"was unplugged while it was opened; plug it in again"};
  if (seen.reports == 0) return Error{"sends no reports; is its firmware running? reset it, or " + install(driver)};
  if (2 * seen.understood > seen.reports) return {};
  if (seen.other_version != 0) {
    return Error{"wrong firmware: speaks version " + std::to_string(seen.other_version) + " of the " + driver.name +
                 " protocol, expected " + std::to_string(driver.version) + "; " + install(driver)};
  }
  return Error{"its reports are none that this program knows; " + install(driver)};
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
      } else if (const Status identified = identify(**connection, *driver); !identified) {
        diagnosis.problem = info.path + ": " + identified.error().message;
      } else {
        diagnosis.driver = driver;
      }
    }
    all.push_back(std::move(diagnosis));
  }
  return all;
}

}  // namespace palpate
