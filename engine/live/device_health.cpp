#include "engine/live/device_health.h"

#include <cmath>

namespace palpate {
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
