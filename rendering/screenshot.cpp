#include "rendering/screenshot.h"

#include <epoxy/gl.h>
#include <png.h>

#include <cstddef>
#include <vector>

#include "engine/atomic_file.h"

namespace palpate {

Status save_screenshot(const std::string& path, int width, int height, bool overwrite) {
  const auto row_bytes = static_cast<std::size_t>(width) * 3;
  std::vector<unsigned char> pixels(row_bytes * static_cast<std::size_t>(height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  // OpenGL's first row is the lowest: a negative stride turns the picture over.
  const auto stride = -static_cast<png_int_32>(row_bytes);
  png_alloc_size_t size = 0;
  if (png_image_write_to_memory(&image, nullptr, &size, 0, pixels.data(), stride, nullptr) == 0) {
    return Error{path + ": cannot be made a PNG: " + image.message};
  }
  std::string file(size, '\0');
  if (png_image_write_to_memory(&image, file.data(), &size, 0, pixels.data(), stride, nullptr) == 0) {
    return Error{path + ": cannot be made a PNG: " + image.message};
  }
  file.resize(size);
  return write_file_atomically(path, file, overwrite);
}

}  // namespace palpate
