#include "engine/live/device_health.h"

#include <array>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

using Words = std::pair<std::uint32_t, const char*>;

constexpr std::array<Words, 11> kWords = {{
    {device_fault::kUnplugged, "unplugged: plug the device in again, then zero it"},
    {device_fault::kLate, "reports come late: no force until they are on time again"},
    {device_fault::kOutOfOrder, "a report came out of order: no force until they are in order again"},
    {device_fault::kBurst, "old reports came in a burst: no force until they are on time again"},
    {device_fault::kCorrupt, "a report was corrupted: no force until they are good again; check the cable"},
    {device_fault::kStuck,
     "the position is stuck although the motor pushes: check the encoder, then zero the device"},
    {device_fault::kJump, "the position jumped: check the encoder, then zero the device"},
    {device_fault::kReset, "the firmware started again: check its supply, then zero the device"},
    {device_fault::kWriteStalled, "commands do not reach the device: no force until they do"},
    {device_fault::kOwn, "the device reports a fault of its own: check its motor and encoder"},
    {device_fault::kWrongFirmware,
     "the firmware speaks another version of the protocol: install the one in devices/"},
}};

}  // namespace

std::vector<std::string> device_fault_words(std::uint32_t faults) {
  std::vector<std::string> list;
  for (const auto& [bit, words] : kWords) {
    if ((faults & bit) != 0) list.emplace_back(words);
  }
  return list;
}

std::string zeroing_words(const DeviceHealth& health) {
  switch (health.zeroing) {
    case Zeroing::needed:
      return "bring the tool to its marked rest position and start zeroing; no force before";
    case Zeroing::hold_still:
      return "zeroing: hold the tool still (" +
             std::to_string(static_cast<int>(std::lround(100.0F * health.zeroing_progress))) + " %)";
    case Zeroing::not_needed:
    case Zeroing::done:
      break;
  }
  return {};
}

}  // namespace palpate
