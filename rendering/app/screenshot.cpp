#include "rendering/app/screenshot.h"

#include <epoxy/gl.h>
#include <png.h>

#include <cstddef>
#include <vector>

#include "engine/base/atomic_file.h"

namespace palpate {

namespace {

constexpr std::size_t kChannels = 3;

Result<std::string> png_of(const std::vector<unsigned char>& pixels, const Framebuffer& picture) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.width);
  image.height = static_cast<png_uint_32>(picture.height);
  image.format = PNG_FORMAT_RGB;
  // OpenGL's first row is the lowest: a negative stride turns the picture over.
  const auto stride = -static_cast<png_int_32>(kChannels * image.width);
  png_alloc_size_t size = 0;
  if (png_image_write_to_memory(&image, nullptr, &size, 0, pixels.data(), stride, nullptr) == 0) {
    return Error{std::string("the picture cannot be made a PNG: ") + image.message};
  }
  std::string file(size, '\0');
  if (png_image_write_to_memory(&image, file.data(), &size, 0, pixels.data(), stride, nullptr) == 0) {
    return Error{std::string("the picture cannot be made a PNG: ") + image.message};
  }
  file.resize(size);
  return file;
}

}  // namespace

Status save_screenshot(Window& window, const std::string& path, bool overwrite) {
  const Framebuffer picture = window.framebuffer();
  std::vector<unsigned char> pixels(kChannels * static_cast<std::size_t>(picture.width) *
                                    static_cast<std::size_t>(picture.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadBuffer(GL_BACK);
  glReadPixels(0, 0, picture.width, picture.height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
  const Result<std::string> png = png_of(pixels, picture);
  window.show_frame();
  if (!png) return png.error();
  return write_file_atomically(path, *png, overwrite);
}

}  // namespace palpate
