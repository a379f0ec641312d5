// The window's picture as a PNG file.
// Thread guarantee: the thread of the OpenGL context.
#pragma once

#include <string>

#include "engine/result.h"

namespace palpate {

// What was drawn into the back buffer, `width` x `height` pixels. Whole or not at
// all. Errors: the file exists and `overwrite` is false; the disk refuses.
Status save_screenshot(const std::string& path, int width, int height, bool overwrite);

}  // namespace palpate
