#include "scenes/scene/method_look.h"

#include "models/fit/methods.h"

namespace palpate {
namespace {

constexpr std::uint32_t kPositionColour = 0xF0E442;  // Okabe & Ito; grey is the band

}  // namespace

std::uint32_t method_rgb(std::string_view method) {
  if (method == "position") return kPositionColour;
  const Method* row = find_method(method);
  return row == nullptr ? kNeutralColour : row->colour;
}

}  // namespace palpate
