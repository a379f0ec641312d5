// What is plugged in, and one open device. The real bus is libhidapi (hidraw);
// tests have their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/hid/hid_reports.h"
#include "engine/base/result.h"

namespace palpate {

struct HidFound {
  std::string path;  // of the node; empty: there is none
  std::string product;
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::uint16_t usage_page = 0;
  std::uint16_t usage = 0;
};

// One open device. `read` belongs to one thread and `write` to one, at the same
// time if need be; the rest is slow side.
class HidLine {
 public:
  virtual ~HidLine() = default;
  // Blocking, for a while: the bytes of the next report; 0: none yet; below 0:
  // the device is gone.
  virtual int read(std::uint8_t* bytes, std::size_t capacity) noexcept = 0;
  // Blocking. False: the device did not take it.
  virtual bool write(const std::uint8_t* bytes, std::size_t size) noexcept = 0;
  // From now on `reports` go out when a signal ends the program, see device_stop.h.
  virtual void stop_with(const OutReports&) noexcept {}
};

class HidBus {
 public:
  virtual ~HidBus() = default;
  // Slow side. One entry per node.
  virtual std::vector<HidFound> list() = 0;
  // Slow side. Errors: why not, and what to do.
  virtual Result<std::unique_ptr<HidLine>> open(const HidFound& found) = 0;
};

// What `found` may be, by its ids; empty: nothing that the program knows.
std::vector<HidKind> possible_kinds(const HidFound& found);

// Slow side: reads reports until they tell which of `kinds` it is. Errors: no
// report comes, another protocol version, reports of the wrong size.
Result<HidKind> identify(HidLine& line, const std::vector<HidKind>& kinds);

// For `palpate devices`: every node, what it would be used as, and why not.
struct HidDiagnosis {
  HidFound found;
  std::optional<HidKind> kind;
  std::string use;      // in words
  std::string problem;  // with what to do; empty: it can be used, or is none of ours
};
std::vector<HidDiagnosis> diagnose(HidBus& bus);

// In words: "haptic paddle" and so on.
const char* hid_kind_words(HidKind kind) noexcept;

}  // namespace palpate
