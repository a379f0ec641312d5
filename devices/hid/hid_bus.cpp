#include "devices/hid/hid_bus.h"

#include <algorithm>
#include <array>

namespace palpate {
namespace {

constexpr std::uint16_t kTeensy = 0x16C0;
constexpr std::uint16_t kRawHidPage = 0xFFAB;
constexpr std::uint16_t kOpenFfBoardVendor = 0x1209, kOpenFfBoard = 0xFFB0;
constexpr std::uint16_t k3Dconnexion = 0x256F, kLogitech = 0x046D;
// Of Logitech's time; later ones have the vendor id of 3Dconnexion.
constexpr std::array<std::uint16_t, 7> kSpaceMice = {0xC626, 0xC627, 0xC628, 0xC629, 0xC62B, 0xC62E, 0xC62F};
constexpr std::uint16_t kDesktopPage = 1, kMultiAxis = 8;

// Reports to judge by; at 1 kHz they come at once.
constexpr int kReportsToJudge = 8;
// Reads that may come back with nothing.
constexpr int kMostEmptyReads = 10;

bool is_space_mouse(const HidFound& found) {
  if (found.usage_page != kDesktopPage || found.usage != kMultiAxis) return false;
  return found.vendor_id == k3Dconnexion ||
         (found.vendor_id == kLogitech &&
          std::find(kSpaceMice.begin(), kSpaceMice.end(), found.product_id) != kSpaceMice.end());
}

bool speaks_by_itself(HidKind kind) { return kind == HidKind::paddle || kind == HidKind::polhem; }

}  // namespace

const char* hid_kind_words(HidKind kind) noexcept {
  switch (kind) {
    case HidKind::paddle:
      return "haptic paddle";
    case HidKind::polhem:
      return "Polhem / WoodenHaptics, one axis";
    case HidKind::openffboard:
      return "OpenFFBoard, one axis";
    case HidKind::spacemouse:
      return "SpaceMouse, input only: no force";
  }
  return "";
}

std::vector<HidKind> possible_kinds(const HidFound& found) {
  if (found.vendor_id == kTeensy && (found.product_id == 0x0486 || found.product_id == 0x0480)) {
    // Its other interface is for messages to a console.
    if (found.usage_page == kRawHidPage) return {HidKind::paddle, HidKind::polhem};
    return {};
  }
  if (found.vendor_id == kOpenFfBoardVendor && found.product_id == kOpenFfBoard)
    return {HidKind::openffboard};
  if (is_space_mouse(found)) return {HidKind::spacemouse};
  return {};
}

Result<HidKind> identify(HidLine& line, const std::vector<HidKind>& kinds) {
  // Silent until it is asked, or until it is touched: its ids must do.
  if (kinds.size() == 1 && !speaks_by_itself(kinds.front())) return kinds.front();
  std::array<int, kHidKinds.size()> good{};
  bool wrong_version = false;
  int size = 0, seen = 0, version = 0;
  for (int empty = 0; seen < kReportsToJudge && empty < kMostEmptyReads;) {
    std::array<std::uint8_t, kLargestHidReport + 1> bytes{};
    size = line.read(bytes.data(), bytes.size());
    if (size < 0) return Error{"was unplugged while it was opened; plug it in again"};
    if (size == 0) {
      ++empty;
      continue;
    }
    ++seen;
    for (const HidKind kind : kinds) {
      HidReading reading;
      const ReportVerdict verdict =
          decode_report(kind, bytes.data(), static_cast<std::size_t>(size), reading);
      if (verdict == ReportVerdict::position) ++good[static_cast<std::size_t>(kind)];
      if (verdict == ReportVerdict::wrong_version) {
        wrong_version = true;
        version = bytes[1];
      }
    }
  }
  if (seen == 0)
    return Error{"sends no reports; is its firmware running? reset it or install devices/firmware/paddle"};
  for (const HidKind kind : kinds) {
    if (2 * good[static_cast<std::size_t>(kind)] > seen) return kind;
  }
  if (wrong_version) {
    return Error{"wrong firmware: speaks version " + std::to_string(version) +
                 " of the paddle protocol, expected 1; install devices/firmware/paddle"};
  }
  if (size != static_cast<int>(kLargestHidReport)) {
    return Error{"wrong report size: found " + std::to_string(size) +
                 " bytes, expected 64; its firmware is another one, "
                 "install devices/firmware/paddle"};
  }
  return Error{"its reports are none that this program knows; install devices/firmware/paddle"};
}

std::vector<HidDiagnosis> diagnose(HidBus& bus) {
  std::vector<HidDiagnosis> all;
  for (const HidFound& found : bus.list()) {
    HidDiagnosis diagnosis{found, std::nullopt, "none that this program uses", ""};
    const std::vector<HidKind> kinds = possible_kinds(found);
    if (!kinds.empty()) {
      diagnosis.use = kinds.size() > 1 ? "haptic paddle or Polhem" : hid_kind_words(kinds.front());
      Result<std::unique_ptr<HidLine>> line = bus.open(found);
      if (!line) {
        diagnosis.problem = line.error().message;
      } else if (const Result<HidKind> kind = identify(**line, kinds); !kind) {
        diagnosis.problem = found.path + ": " + kind.error().message;
      } else {
        diagnosis.kind = *kind;
        diagnosis.use = hid_kind_words(*kind);
      }
    }
    all.push_back(std::move(diagnosis));
  }
  return all;
}

}  // namespace palpate
