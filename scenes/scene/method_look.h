// The colours of methods, for whoever draws without seeing the models.
// Thread guarantee: pure function.
#pragma once

#include <cstdint>
#include <string_view>

namespace palpate {

// 0xRRGGBB of a row of models/fit/methods.h, or of "position", the slot of a live
// session that knows the depth alone. 0 means black on white and white on black: of
// the methods without a hue, and of what is not known.
std::uint32_t method_rgb(std::string_view method);

}  // namespace palpate
